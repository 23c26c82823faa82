#include "app/inspect/companion_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace macadam {
namespace {

bool has(const Inspection& log, std::string_view channel) {
    return log.detected->has(channel, Confidence::likely);
}

bool holds_motion_alone(const Inspection& log) {
    return has(log, "acc_z_mps2") && !has(log, "lat_deg");
}

bool holds_positions_alone(const Inspection& log) {
    return has(log, "lat_deg") && has(log, "lon_deg") && !has(log, "acc_z_mps2");
}

bool is_at_same_time(const TripSummary& a, const TripSummary& b) {
    constexpr double min_overlap_share = 0.8; // of the shorter one
    const double shorter_s = std::min(a.duration_s, b.duration_s);
    if (a.t0_utc_s && b.t0_utc_s) {
        const double overlap_s = std::min(*a.t0_utc_s + a.duration_s, *b.t0_utc_s + b.duration_s) -
                                 std::max(*a.t0_utc_s, *b.t0_utc_s);
        return shorter_s > 0 && overlap_s > min_overlap_share * shorter_s;
    }
    constexpr double max_difference_s = 3;
    return !a.t0_utc_s && !b.t0_utc_s && shorter_s > 0 &&
           std::abs(a.duration_s - b.duration_s) < max_difference_s;
}

std::filesystem::path folder_of(const Inspection& log) {
    return std::filesystem::path{log.name}.parent_path();
}

} // namespace

std::optional<CompanionLogs> companions_in(const std::vector<Inspection>& logs) {
    for (const auto& motion : logs) {
        if (!motion.trip || !holds_motion_alone(motion)) {
            continue;
        }
        for (const auto& positions : logs) {
            if (positions.trip && holds_positions_alone(positions) &&
                folder_of(motion) == folder_of(positions) &&
                is_at_same_time(*motion.trip, *positions.trip)) {
                return CompanionLogs{&motion, &positions};
            }
        }
    }
    return std::nullopt;
}

std::string mapping_of(const CompanionLogs& logs) {
    const auto motion = std::filesystem::path{logs.motion->name}.filename().string();
    const auto positions = std::filesystem::path{logs.positions->name}.filename().string();
    // A common beginning, such as a date, is another one in the next pair.
    const auto differ = std::ranges::mismatch(motion, positions).in1;
    const auto common = motion.substr(0, static_cast<std::size_t>(differ - motion.begin()));
    const auto cut = common.find_last_of("_-. ");
    const auto pattern = [&](const std::string& name) {
        return cut == std::string::npos ? name : fmt::format("*{}", name.substr(cut));
    };
    return mapping_toml({*logs.motion->detected, pattern(motion)},
                        {*logs.positions->detected, pattern(positions)});
}

} // namespace macadam
