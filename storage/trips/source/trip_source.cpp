#include "storage/trips/source/trip_source.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {

TripNeeds needs_of_match() {
    return {.speed = true, .fixes = true, .columns = {{"t_s"}, {"lat_deg"}, {"lon_deg"}}};
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
            .columns = {{"t_s"},
                        {"acc_z_mps2", "acc_y_mps2"},
                        {"speed_mps",
                         "gnss_speed_mps",
                         "wheel_fl_mps",
                         "wheel_fr_mps",
                         "wheel_rl_mps",
                         "wheel_rr_mps"}}};
}

TripNeeds needs_of_import() {
    auto needs = needs_of_trace();
    needs.columns.push_back({"lat_deg"});
    needs.columns.push_back({"lon_deg"});
    return needs;
}

std::string missing_columns(const TripNeeds& needs,
                            const std::function<bool(const std::string& column)>& has) {
    std::vector<std::string> missing;
    for (const auto& group : needs.columns) {
        if (std::ranges::none_of(group, has)) {
            missing.push_back(fmt::format("{}", fmt::join(group, " or ")));
        }
    }
    return fmt::format("{}", fmt::join(missing, " and "));
}

std::string TripSource::name() const {
    return member.empty() ? file.string() : file.string() + "/" + member;
}

} // namespace macadam
