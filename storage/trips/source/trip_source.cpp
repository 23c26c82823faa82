#include "storage/trips/source/trip_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace macadam {

namespace {

NeededMeasurement time() {
    return {"time", "", {"t_s"}};
}

NeededMeasurement latitude() {
    return {"position", "latitude", {"lat_deg"}};
}

NeededMeasurement longitude() {
    return {"position", "longitude", {"lon_deg"}};
}

std::vector<NeededMeasurement> missing_in(const TripNeeds& needs, const ColumnTest& has) {
    std::vector<NeededMeasurement> missing;
    std::ranges::copy_if(
        needs.required, std::back_inserter(missing), [&](const NeededMeasurement& needed) {
            return std::ranges::none_of(needed.columns, has);
        });
    return missing;
}

} // namespace

TripNeeds needs_of_match() {
    return {.speed = true, .fixes = true, .required = {time(), latitude(), longitude()}};
}

TripNeeds needs_of_match_with_heading() {
    auto needs = needs_of_match();
    needs.acc = needs.gyro = true;
    return needs;
}

TripNeeds needs_of_trace() {
    return {.acc = true,
            .gyro = true,
            .speed = true,
            .fixes = true,
            .required = {time(),
                         {"vertical acceleration", "", {"acc_z_mps2", "acc_y_mps2"}},
                         {"speed of the car or of the receiver",
                          "",
                          {"speed_mps",
                           "gnss_speed_mps",
                           "wheel_fl_mps",
                           "wheel_fr_mps",
                           "wheel_rl_mps",
                           "wheel_rr_mps"}}}};
}

TripNeeds needs_of_import() {
    auto needs = needs_of_trace();
    needs.required.push_back(latitude());
    needs.required.push_back(longitude());
    return needs;
}

bool is_position_column(const std::string& column) {
    static constexpr std::array<std::string_view, 6> columns{
        "t_s", "lat_deg", "lon_deg", "gnss_speed_mps", "course_deg", "hacc_m"};
    return std::ranges::find(columns, column) != columns.end();
}

TripNeeds needs_beside_positions(const TripNeeds& needs) {
    TripNeeds of_log{.acc = true, .gyro = true, .speed = true, .fixes = false, .required = {}};
    for (const auto& needed : needs.required) {
        const bool is_time = needed.columns.front() == "t_s";
        if (is_time || std::ranges::none_of(needed.columns, is_position_column)) {
            of_log.required.push_back(needed);
        }
    }
    return of_log;
}

std::string missing_measurements(const TripNeeds& needs, const ColumnTest& has) {
    std::vector<std::string> words;
    std::string last;
    for (const auto& [name, part, columns] : missing_in(needs, has)) {
        if (!part.empty() && name == last) {
            words.back().replace(words.back().size() - 1, 1, fmt::format(", {})", part));
        } else {
            words.push_back(part.empty() ? name : fmt::format("{} ({})", name, part));
        }
        last = name;
    }
    return fmt::format("{}", fmt::join(words, "; "));
}

std::string missing_columns(const TripNeeds& needs, const ColumnTest& has) {
    std::vector<std::string> names;
    for (const auto& needed : missing_in(needs, has)) {
        const auto& columns = needed.columns;
        names.push_back(columns.size() == 1 ? columns[0]
                                            : fmt::format("{} or {}", columns[0], columns[1]));
    }
    return fmt::format("{}", fmt::join(names, " and "));
}

std::string TripSource::name() const {
    return member.empty() ? file.string() : file.string() + "/" + member;
}

} // namespace macadam
