#include "app/database/car_names.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace macadam {

std::string car_named(const StoreReader& store, const std::string& name) {
    if (store.settings().privacy == PrivacyProfile::crowd) {
        throw InputError{fmt::format("{}: is a crowd database, which tells no cars apart; leave "
                                     "the option that names one out",
                                     store.file().string())};
    }
    const auto cars = store.usage().cars;
    const auto is_known = [&](const std::string& car) {
        return std::ranges::find(cars, car) != cars.end();
    };
    if (is_known(name)) {
        return name;
    }
    if (const auto* const key = store.key(); key != nullptr && is_known(key->pseudonym(name))) {
        return key->pseudonym(name);
    }
    constexpr std::size_t shown = 5;
    throw InputError{fmt::format(
        "{}: has no car '{}', expected a vehicle_id or a pseudonym such as "
        "{}; 'macadam info' lists them",
        store.file().string(),
        name,
        fmt::join(cars.begin(),
                  cars.begin() + static_cast<std::ptrdiff_t>(std::min(shown, cars.size())),
                  ", "))};
}

int number_of_car(const std::vector<std::string>& cars, const std::string& car) {
    return static_cast<int>(std::ranges::find(cars, car) - cars.begin()) + 1;
}

} // namespace macadam
