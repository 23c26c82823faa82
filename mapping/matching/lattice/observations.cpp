#include "mapping/matching/lattice/observations.hpp"

#include "estimator/common/angle.hpp"
#include "mapping/matching/lattice/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace macadam {
namespace {

constexpr double worst_radius_m = 100;      // a worse fix could be on any road of the quarter
constexpr double fastest_mps = 90;          // faster than any car
constexpr double jump_slack_m = 30;         // of noise, which at 10 Hz looks like 300 m/s
constexpr std::size_t longest_fault = 10;   // fixes; longer runs are kept and leave a gap
constexpr double course_from_mps = 2;       // below it a receiver's course is noise
constexpr float axis_per_radius = 1 / 1.5F; // a 68 % radius is 1.5 sd of one axis (Rayleigh)

bool is_same(const GnssFix& a, const GnssFix& b) {
    const auto same = [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    return a.at == b.at && same(a.speed_mps, b.speed_mps) && same(a.course_deg, b.course_deg);
}

/// Checks each fix by itself and against the previous one; `std::nullopt`: may be usable.
std::vector<std::optional<RowReason>> own_faults(const std::vector<GnssFix>& fixes,
                                                 double worst_accuracy_m) {
    std::vector<std::optional<RowReason>> faults(fixes.size());
    const GnssFix* before = nullptr;
    for (std::size_t i = 0; i < fixes.size(); ++i) {
        const auto& fix = fixes[i];
        if (!std::isfinite(fix.at.lat_deg) || !std::isfinite(fix.at.lon_deg)) {
            faults[i] = RowReason::no_sample;
        } else if (fix.accuracy_m > worst_accuracy_m) {
            faults[i] = RowReason::inaccurate;
        } else if (before != nullptr && is_same(*before, fix)) {
            faults[i] = RowReason::repeated_fix;
        } else {
            before = &fix;
        }
    }
    return faults;
}

/// Consecutive fixes that a car can have driven.
struct Run {
    std::size_t first; ///< index into the fixes that may be usable
    std::size_t count;
};

bool is_drivable(const GnssFix& a, const GnssFix& b) {
    constexpr double longest_degree_m = 111'700; // of latitude or longitude, on the ellipsoid
    const double reach_m = jump_slack_m + fastest_mps * std::max(0.0, b.t_s - a.t_s);
    const double degrees = std::abs(b.at.lat_deg - a.at.lat_deg) +
                           std::abs(b.at.lon_deg - a.at.lon_deg); // usually enough to decide
    return longest_degree_m * degrees <= reach_m || distance_m(a.at, b.at) <= reach_m;
}

std::vector<Run> runs_of(const std::vector<GnssFix>& fixes, const std::vector<std::size_t>& serve) {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < serve.size(); ++i) {
        if (i == 0 || !is_drivable(fixes[serve[i - 1]], fixes[serve[i]])) {
            runs.push_back({i, 0});
        }
        ++runs.back().count;
    }
    return runs;
}

/// Removes short runs that contradict a longer neighbour: of two that no car could have driven
/// between, the shorter is faulty.
std::vector<Run> without_jumps(const std::vector<Run>& runs,
                               const std::vector<GnssFix>& fixes,
                               const std::vector<std::size_t>& serve) {
    std::vector<Run> kept;
    const auto contradict = [&](const Run& a, const Run& b) {
        return !is_drivable(fixes[serve[a.first + a.count - 1]], fixes[serve[b.first]]);
    };
    for (const auto& run : runs) {
        while (!kept.empty() && contradict(kept.back(), run) && kept.back().count < run.count &&
               kept.back().count <= longest_fault) {
            kept.pop_back();
        }
        if (kept.empty() || !contradict(kept.back(), run) || run.count > longest_fault) {
            kept.push_back(run);
        }
    }
    return kept;
}

void mark_jumps(std::vector<std::optional<RowReason>>& faults, const std::vector<GnssFix>& fixes) {
    std::vector<std::size_t> serve;
    for (std::size_t i = 0; i < fixes.size(); ++i) {
        if (!faults[i]) {
            serve.push_back(i);
            faults[i] = RowReason::implausible; // until a kept run clears it
        }
    }
    for (const auto& run : without_jumps(runs_of(fixes, serve), fixes, serve)) {
        for (std::size_t i = run.first; i < run.first + run.count; ++i) {
            faults[serve[i]].reset();
        }
    }
}

GeoPoint middle_of(const std::vector<GeoPoint>& places) {
    GeoBox box;
    for (const auto& place : places) {
        box = including(box, place);
    }
    return between({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg}, 0.5);
}

bool has_speed(const TripLog& trip) {
    const auto known = std::count_if(trip.fixes.begin(), trip.fixes.end(), [](const auto& fix) {
        return std::isfinite(fix.speed_mps);
    });
    return !trip.speed.t_s.empty() || 2 * static_cast<std::size_t>(known) > trip.fixes.size();
}

float course_rad(const GnssFix& fix) {
    return fix.speed_mps > course_from_mps ? static_cast<float>(fix.course_deg * rad_per_deg)
                                           : std::numeric_limits<float>::quiet_NaN();
}

float own_sd_m(const GnssFix& fix) {
    constexpr float best_m = 3; // receivers overstate their accuracy
    constexpr float usual_m = 5;
    return std::isfinite(fix.accuracy_m) ? std::max(best_m, fix.accuracy_m * axis_per_radius)
                                         : usual_m;
}

/// Adds dead-reckoned positions where fixes are far apart.
std::vector<Position> with_dead_reckoned(const MatchObservations& positions,
                                         const Odometer& odometer,
                                         const MatchConfig& config) {
    const auto places = dead_reckoned(positions, odometer, config.spacing_m);
    std::vector<Position> all;
    all.reserve(positions.all.size() + places.size());
    auto next = places.begin();
    for (const auto& position : positions.all) {
        for (; next != places.end() && next->travel_m < position.travel_m; ++next) {
            all.push_back({next->t_s,
                           next->travel_m,
                           next->at,
                           positions.frame.to_geo(next->at),
                           static_cast<float>(std::hypot(config.emission_sd_m, next->sd_m)),
                           static_cast<float>(next->sd_m),
                           next->course_rad,
                           true});
        }
        all.push_back(position);
    }
    return all;
}

/// Selects one sample per spacing_m of travel, and one while the car stands.
std::vector<std::size_t> thinned(const MatchObservations& positions, double spacing_m) {
    std::vector<std::size_t> samples;
    const auto& all = positions.all;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i == 0) {
            samples.push_back(i);
            continue;
        }
        const auto& last = all[samples.back()];
        // Travel summed from positions grows with their noise even while the car stands.
        const double gone_m = positions.odometer ? all[i].travel_m - last.travel_m
                                                 : std::hypot(all[i].at.east_m - last.at.east_m,
                                                              all[i].at.north_m - last.at.north_m);
        if (gone_m >= spacing_m || i + 1 == all.size()) {
            samples.push_back(i);
        }
    }
    return samples;
}

/// Only other sensors reveal the latency; an unstated latency of 0 was not estimated.
double latency_sd_s(const TripLog& trip, const Heading& heading) {
    constexpr double stated_s = 0.02;
    constexpr double estimated_s = 0.1;
    constexpr double anything_s = 1;
    if (trip.speed.t_s.empty() && heading.turned_rad.empty()) {
        return 0;
    }
    return trip.meta.gnss_latency_stated     ? stated_s
           : trip.meta.gnss_latency_sd_s > 0 ? trip.meta.gnss_latency_sd_s
           : trip.meta.gnss_latency_s > 0    ? estimated_s
                                             : anything_s;
}

} // namespace

std::vector<std::optional<RowReason>> faults_of(const std::vector<GnssFix>& fixes,
                                                double worst_accuracy_m) {
    auto faults = own_faults(fixes, worst_accuracy_m);
    mark_jumps(faults, fixes);
    return faults;
}

MatchObservations positions_of(const TripLog& trip,
                               const Odometer& odometer,
                               const Heading& heading,
                               const MatchConfig& config) {
    const auto faults = faults_of(trip.fixes, worst_radius_m);

    MatchObservations positions{{}, has_speed(trip), {}, {}, &heading, latency_sd_s(trip, heading)};
    std::vector<GeoPoint> places;
    positions.use.resize(trip.fixes.size());
    for (std::size_t i = 0; i < trip.fixes.size(); ++i) {
        if (!faults[i]) {
            const auto& fix = trip.fixes[i];
            const double t_s = fix.t_s - trip.meta.gnss_latency_s;
            const float own_sd = own_sd_m(fix);
            places.push_back(fix.at);
            positions.all.push_back({t_s,
                                     odometer.travel_m(t_s),
                                     {},
                                     fix.at,
                                     static_cast<float>(std::hypot(config.emission_sd_m, own_sd)),
                                     own_sd,
                                     course_rad(fix)});
        } else {
            positions.use[i] = code(*faults[i]);
        }
    }
    if (places.empty()) {
        return positions;
    }
    positions.frame = {middle_of(places)};
    const auto local = positions.frame.to_local(places);
    for (std::size_t i = 0; i < local.size(); ++i) {
        positions.all[i].at = local[i];
    }
    positions.all = with_dead_reckoned(positions, odometer, config);
    positions.samples = thinned(positions, config.spacing_m);
    return positions;
}

} // namespace macadam
