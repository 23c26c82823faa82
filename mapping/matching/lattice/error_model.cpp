#include "mapping/matching/lattice/error_model.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace macadam {
namespace {

// Position errors are correlated from sample to sample, so one sample carries much less information
// than its error suggests: hence an sd of several times the median distance.
constexpr std::size_t asked_samples = 60;
constexpr double sd_per_median = 5.5;
constexpr double usual_m = 30; // hardly any position lies farther from its road
constexpr double best_share = 0.5;
constexpr double sample_weight = 0.75;
constexpr double min_close_sd_m = 3;                     // maps have errors too
constexpr double farthest_lane_m = 20;                   // from a road's line
constexpr double lane_doubt = 8;                         // weight of the prior, in samples
constexpr double drawn_course_sd_rad = 60 * rad_per_deg; // positions wander sideways together
constexpr double chord_spread = 0.1;     // uncertainty of path length against its chord
constexpr double odometer_spread = 0.02; // scale of the odometer and corners cut by the map
constexpr double standing_mps = 2;       // mean speed below which the car stood
constexpr double standing_s = 5;
constexpr double error_memory_s = 30; // correlation time of the receiver's error
constexpr double mean_of_two = 1.13;  // mean |difference| of two normal errors, in sd of one
constexpr double min_step_m = 10;     // of the line through positions: shorter steps are noise
constexpr double dense_m = 60;        // a longer step may hide a detour

const Turn unmeasured{0, std::numeric_limits<double>::infinity()};

double apart_m(const Position& a, const Position& b) {
    const double east_m = b.at.east_m - a.at.east_m;
    const double north_m = b.at.north_m - a.at.north_m;
    return std::sqrt(east_m * east_m + north_m * north_m);
}

double course_between(const Position& a, const Position& b) {
    return std::atan2(b.at.east_m - a.at.east_m, b.at.north_m - a.at.north_m);
}

constexpr double arm_m = 10; // of a course from positions: to the one before and the one after
constexpr double longest_arm_m = 60; // the road may bend within more
constexpr double longest_arm_s = 8;
constexpr double straight_rad = 1; // arms that meet at a larger angle are a corner or noise

/// Finds the first position at least arm_m away in the direction of `step`; `std::nullopt` if none
/// is nearby.
std::optional<std::size_t> arm(const MatchObservations& positions, std::size_t from, int step) {
    const auto& all = positions.all;
    for (auto i = static_cast<std::ptrdiff_t>(from) + step;
         i >= 0 && i < static_cast<std::ptrdiff_t>(all.size());
         i += step) {
        const auto& there = all[static_cast<std::size_t>(i)];
        const double away_m = apart_m(there, all[from]);
        if (away_m > longest_arm_m || std::abs(there.t_s - all[from].t_s) > longest_arm_s) {
            return {};
        }
        if (away_m >= arm_m) {
            return static_cast<std::size_t>(i);
        }
    }
    return {};
}

struct Course {
    double course_rad;
    double sd_rad;
};

std::optional<Course> drawn_course(const MatchObservations& positions, std::size_t at) {
    const auto& all = positions.all;
    const auto before = arm(positions, at, -1);
    const auto after = arm(positions, at, 1);
    if (!before && !after) {
        return {};
    }
    const auto& a = all[before.value_or(at)];
    const auto& b = all[after.value_or(at)];
    if (before && after &&
        std::abs(std::remainder(course_between(a, all[at]) - course_between(all[at], b),
                                2 * std::numbers::pi)) > straight_rad) {
        return {};
    }
    const double sd_m = std::numbers::sqrt2 * static_cast<double>(all[at].own_sd_m);
    return Course{course_between(a, b), sd_m / apart_m(a, b)};
}

/// Length of the line through the positions. Positions too close to the previous one are skipped,
/// as they add noise.
struct Drawn {
    double length_m;
    double longest_m; ///< of its steps
};

Drawn drawn_between(const MatchObservations& positions, std::size_t from, std::size_t to) {
    const auto& all = positions.all;
    Drawn drawn{0, 0};
    auto last = from;
    for (auto i = from + 1; i <= to; ++i) {
        const double step_m = apart_m(all[last], all[i]);
        if (step_m >= min_step_m || i == to) {
            drawn.length_m += step_m;
            drawn.longest_m = std::max(drawn.longest_m, step_m);
            last = i;
        }
    }
    return drawn;
}

/// The nearest road to a sample that is drivable in the direction of its course.
struct Beside {
    double distance_m;
    double right_m;
    bool two_way;
    bool lane_known; ///< true if right_m is a lane offset: the course is known and the road is near
};

std::optional<Beside> beside(const MatchObservations& positions,
                             std::size_t at,
                             const RoadNetwork& roads,
                             CandidateIndex& plane,
                             const MatchConfig& config) {
    const auto& position = positions.all[at];
    const auto course = drawn_course(positions, at);
    for (const double radius_m :
         {std::min(usual_m, config.search_radius_m), config.search_radius_m}) {
        for (const auto& place : plane.near(position.at, position.place, radius_m)) {
            const bool along = !course || std::cos(course->course_rad - place.course_rad) > 0;
            const bool against = !course || std::cos(course->course_rad - place.course_rad) < 0;
            const bool forward = is_drivable(roads, edge_of(place.link, true));
            const bool backward = is_drivable(roads, edge_of(place.link, false));
            if ((along && forward) || (against && backward)) {
                return Beside{place.distance_m,
                              along ? place.right_m : -place.right_m,
                              forward && backward,
                              course && place.distance_m < farthest_lane_m};
            }
        }
    }
    return {};
}

/// Estimates the lane offset on roads of one kind, shrunk towards 0 if samples are few.
double lane_m(std::span<const Beside> besides, bool two_way) {
    std::vector<double> right_m;
    for (const auto& road : besides) {
        if (road.lane_known && road.two_way == two_way) {
            right_m.push_back(road.right_m);
        }
    }
    const auto count = static_cast<double>(right_m.size());
    return right_m.empty() ? 0 : median(std::move(right_m)) * count / (count + lane_doubt);
}

} // namespace

RoadSpread road_spread(const MatchObservations& positions,
                       const RoadNetwork& roads,
                       CandidateIndex& plane,
                       const MatchConfig& config) {
    const auto& samples = positions.samples;
    const auto step = std::max<std::size_t>(1, samples.size() / asked_samples);
    std::vector<Beside> besides;
    for (std::size_t i = 0; i < samples.size(); i += step) {
        if (const auto found = beside(positions, samples[i], roads, plane, config)) {
            besides.push_back(*found);
        }
    }
    if (besides.empty()) {
        return {config.emission_sd_m, config.emission_sd_m, 0, 0};
    }
    const double oneway_m = lane_m(besides, false);
    const double two_way_m = lane_m(besides, true);
    std::vector<double> from_line_m;
    std::vector<double> from_lane_m;
    for (const auto& road : besides) {
        from_line_m.push_back(road.distance_m);
        from_lane_m.push_back(road.lane_known
                                  ? std::abs(road.right_m - (road.two_way ? two_way_m : oneway_m))
                                  : road.distance_m);
    }
    const double min_m = best_share * config.emission_sd_m;
    return {std::clamp(sd_per_median * median(from_line_m), min_m, config.emission_sd_m),
            std::max(min_close_sd_m, normal_sd_per_mad * median(from_lane_m)),
            oneway_m,
            two_way_m};
}

ObservationModel evidence_of(const MatchObservations& positions,
                             std::size_t sample,
                             double road_sd_m,
                             const MatchConfig& config) {
    const auto at = positions.samples[sample];
    const auto& position = positions.all[at];
    ObservationModel evidence{std::hypot(road_sd_m, position.own_sd_m),
                              position.course_rad,
                              drawn_course_sd_rad,
                              sample_weight};
    if (!std::isnan(evidence.course_rad)) {
        evidence.course_sd_rad = config.course_sd_deg * rad_per_deg;
    } else if (const auto course = drawn_course(positions, at)) {
        evidence.course_rad = course->course_rad;
        evidence.course_sd_rad = std::hypot(evidence.course_sd_rad, course->sd_rad);
    }
    return evidence;
}

SamplePair between_samples(const MatchObservations& positions,
                           std::size_t from,
                           std::size_t to,
                           const MatchConfig& config) {
    const auto& a = positions.all[from];
    const auto& b = positions.all[to];
    const auto drawn = drawn_between(positions, from, to);
    const double took_s = b.t_s - a.t_s;
    const double travelled_m = positions.odometer ? b.travel_m - a.travel_m : apart_m(a, b);
    const double scale_m = positions.odometer
                               ? config.odometer_scale_m + odometer_spread * travelled_m
                               : config.transition_scale_m + chord_spread * travelled_m;
    return {std::exp(-took_s / error_memory_s),
            took_s,
            travelled_m,
            drawn.length_m,
            scale_m,
            mean_of_two * static_cast<double>(a.own_sd_m) / scale_m,
            positions.heading == nullptr ? unmeasured : turned(*positions.heading, a.t_s, b.t_s),
            took_s > standing_s && travelled_m < standing_mps * took_s,
            drawn.longest_m < dense_m};
}

} // namespace macadam
