#include "mapping/conflation/matched_runs.hpp"

#include "mapping/geometry/line_simplification.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace macadam {
namespace {

constexpr double max_proportioned_m = 400; // beyond, perpendicular feet are more accurate
constexpr double straight_m = 0.3; // along the road; smaller deviations are digitising noise
constexpr double step_back_m = 6;  // as in a walk; more is a second lap of a loop

/// Old and new station of one point.
struct StationPair {
    double before_m;
    double after_m;
};

/// The part of a run on one way in one direction.
struct Stretch {
    std::uint32_t way;
    bool forward;
    std::vector<StationPair> pairs; ///< both stations increase
};

/// Returns the travelled distance along the new roads for each position of a run.
std::vector<double> gone_m(const WayMatchRun& run) {
    std::vector<double> gone{0};
    for (std::size_t i = 1; i < run.size(); ++i) {
        const bool same_edge = run[i].edge == run[i - 1].edge;
        gone.push_back(gone.back() + (same_edge ? run[i].along_m - run[i - 1].along_m : 0));
    }
    return gone;
}

bool is_at_change(const WayMatchRun& run, std::size_t i) {
    return (i > 0 && run[i - 1].edge != run[i].edge) ||
           (i + 1 < run.size() && run[i + 1].edge != run[i].edge);
}

/// Between two nodes common to both networks, lengths are more accurate than perpendicular feet,
/// which lag behind where the map was shifted along the road.
WayMatchRun proportioned(const WayMatchRun& run, const ChangeConfig& config) {
    const auto gone = gone_m(run);
    WayMatchRun result;
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < run.size(); ++i) {
        result.push_back(run[i]);
        if (!run[i].is_node) {
            continue;
        }
        if (last) {
            const double new_m = gone[i] - gone[*last];
            const double old_m = run[i].offset_m - run[*last].offset_m;
            if (new_m > 0 && old_m <= max_proportioned_m &&
                std::abs(new_m - old_m) <= config.max_stretched_m + config.max_stretched * old_m) {
                result.resize(result.size() - (i - *last));
                for (auto k = *last + 1; k <= i; ++k) {
                    if (k == i || is_at_change(run, k)) {
                        result.push_back(run[k]);
                        result.back().offset_m =
                            run[*last].offset_m + old_m * (gone[k] - gone[*last]) / new_m;
                    }
                }
            }
        }
        last = i;
    }
    return result;
}

double station_on(const Link& link, bool forward, double along_m) {
    return forward ? link.from_m + along_m : along_m - link.to_m;
}

std::vector<Stretch> stretches_of(const RoadNetwork& after, const WayMatchRun& run) {
    std::vector<Stretch> stretches;
    for (const auto& place : run) {
        const auto link = link_at(after, place.edge);
        const bool forward = is_forward(place.edge);
        const double at_m = station_on(link, forward, place.along_m);
        if (stretches.empty() || stretches.back().way != link.way ||
            stretches.back().forward != forward ||
            at_m < stretches.back().pairs.back().after_m - step_back_m) {
            stretches.push_back({link.way, forward, {}});
        }
        auto& pairs = stretches.back().pairs;
        const double min_m = pairs.empty() ? at_m : pairs.back().after_m;
        pairs.push_back({place.offset_m, std::max(at_m, min_m)});
    }
    return stretches;
}

/// Keeps the minimum of pairs, always including the last: those off the straight line between their
/// neighbours.
std::vector<StationPair> straightened(std::span<const StationPair> pairs) {
    const auto off_line_m = [&](std::size_t i, std::size_t from, std::size_t to) {
        const auto &first = pairs[from], &last = pairs[to];
        const double slope = last.before_m > first.before_m
                                 ? (last.after_m - first.after_m) / (last.before_m - first.before_m)
                                 : 0;
        const double on_line_m = first.after_m + slope * (pairs[i].before_m - first.before_m);
        return std::abs(pairs[i].after_m - on_line_m);
    };
    std::vector<bool> stays(pairs.size(), false);
    if (!pairs.empty()) {
        stays.front() = stays.back() = true;
        keep_bends(0, pairs.size() - 1, straight_m, off_line_m, stays);
    }
    std::vector<StationPair> straight;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (stays[i]) {
            straight.push_back(pairs[i]);
        }
    }
    return straight;
}

double whole_mm(double at_m) {
    return std::round(at_m * 1000) / 1000;
}

double before_m(const WayMatchRun& run) {
    return run.back().offset_m - run.front().offset_m;
}

double after_m(const std::vector<Stretch>& stretches) {
    double sum_m = 0;
    for (const auto& stretch : stretches) {
        sum_m += stretch.pairs.back().after_m - stretch.pairs.front().after_m;
    }
    return sum_m;
}

} // namespace

std::vector<RoadCorrespondence> same_roads(const RoadNetwork& before,
                                           const RoadNetwork& after,
                                           std::uint32_t way,
                                           bool forward,
                                           const std::vector<WayMatchRun>& runs,
                                           const std::vector<bool>& left_out,
                                           const ChangeConfig& config) {
    const auto old = way_at(before, way);
    const double whole_m = old.along_m.back();
    const double start_m = forward ? 0 : -whole_m;
    std::vector<RoadCorrespondence> roads;
    for (const auto& walked : runs) {
        const auto run = proportioned(walked, config);
        const auto stretches = stretches_of(after, run);
        const double run_m = before_m(run);
        const bool is_long = run_m >= std::min(config.min_run_m, whole_m / 2);
        const bool is_as_long = std::abs(after_m(stretches) - run_m) <=
                                config.max_stretched_m + config.max_stretched * run_m;
        if (!is_long || !is_as_long) {
            continue;
        }
        for (const auto& stretch : stretches) {
            const auto pairs = straightened(stretch.pairs);
            for (std::size_t i = 1; i < pairs.size() && !left_out[stretch.way]; ++i) {
                const RoadCorrespondence road{{old.id,
                                               forward,
                                               whole_mm(start_m + pairs[i - 1].before_m),
                                               whole_mm(start_m + pairs[i].before_m)},
                                              {way_at(after, stretch.way).id,
                                               stretch.forward,
                                               whole_mm(pairs[i - 1].after_m),
                                               whole_mm(pairs[i].after_m)}};
                if (road.before.to_station_m > road.before.from_station_m &&
                    road.after.to_station_m > road.after.from_station_m) {
                    roads.push_back(road);
                }
            }
        }
    }
    return roads;
}

} // namespace macadam
