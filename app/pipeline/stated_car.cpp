#include "app/pipeline/stated_car.hpp"

#include "estimator/common/error.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

/// Value of a key; "" if it is not stated.
std::string stated(const TripMeta& meta, const char* key) {
    const auto found = meta.other.find(key);
    return found == meta.other.end() || found->second == "unknown" ? "" : found->second;
}

BodyType body_of(const std::string& name) {
    const auto body = std::ranges::find(body_types(), name, &BodyType::name);
    if (body == body_types().end()) {
        std::vector<std::string_view> names;
        for (const auto& known : body_types()) {
            names.push_back(known.name);
        }
        throw InputError{fmt::format(
            "key 'car_body' is {}, expected one of {}", in_quotes(name), fmt::join(names, ", "))};
    }
    return *body;
}

double number_in(std::string_view key,
                 const std::string& value,
                 const ValueRange& range,
                 std::string_view unit,
                 const BodyType& body) {
    const auto number = parse_number(value);
    if (!number || !range.contains(*number)) {
        throw InputError{fmt::format("key '{}' is {}, expected {} to {} {} for car_body {}",
                                     key,
                                     in_quotes(value),
                                     range.min,
                                     range.max,
                                     unit,
                                     body.name)};
    }
    return *number;
}

} // namespace

std::optional<Vehicle> stated_car(const TripMeta& meta) {
    const auto name = stated(meta, "car_body");
    const auto mass_kg = stated(meta, "car_mass_kg");
    const auto wheelbase_m = stated(meta, "car_wheelbase_m");
    if (name.empty() || mass_kg.empty() || wheelbase_m.empty()) {
        return std::nullopt;
    }
    const auto body = body_of(name);
    return vehicle_of(
        {.mass_kg = number_in("car_mass_kg", mass_kg, body.mass_kg, "kg", body),
         .wheelbase_m = number_in("car_wheelbase_m", wheelbase_m, body.wheelbase_m, "m", body),
         .body = body},
        std::string{name});
}

} // namespace macadam
