#include "mapping/matching/map_match.hpp"

#include "mapping/matching/lattice/candidate_index.hpp"
#include "mapping/matching/lattice/edge_routing.hpp"
#include "mapping/matching/lattice/gap.hpp"
#include "mapping/matching/lattice/lattice.hpp"
#include "mapping/matching/lattice/observations.hpp"
#include "mapping/matching/placement/matched_path.hpp"
#include "mapping/matching/placement/offset_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double straight_m = 0.25; // maximum error of the offset within an interval

/// Interpolates the knots at a path position, clamped to their ends.
PathSample knot_at(const std::vector<PathSample>& knots, double along_m) {
    const auto next =
        std::lower_bound(knots.begin(), knots.end(), along_m, [](const PathSample& knot, double m) {
            return knot.along_m < m;
        });
    if (next == knots.begin() || next == knots.end()) {
        const auto& end = next == knots.end() ? knots.back() : *next;
        return {end.travel_m, along_m, end.sd_m};
    }
    const auto& before = *(next - 1);
    const double share = (along_m - before.along_m) / (next->along_m - before.along_m);
    return {std::lerp(before.travel_m, next->travel_m, share),
            along_m,
            std::lerp(before.sd_m, next->sd_m, share)};
}

/// Returns the knots between two path positions, with new ones at both.
std::vector<PathSample> clipped(const std::vector<PathSample>& knots, double from_m, double to_m) {
    if (knots.empty()) {
        return {};
    }
    from_m = std::max(from_m, knots.front().along_m);
    to_m = std::min(to_m, knots.back().along_m);
    if (!(from_m < to_m)) {
        return {};
    }
    std::vector<PathSample> inside{knot_at(knots, from_m)};
    const auto last = knot_at(knots, to_m);
    for (auto knot = std::upper_bound(knots.begin(),
                                      knots.end(),
                                      inside.front().travel_m,
                                      [](double m, const PathSample&k) { return m < k.travel_m; });
         knot != knots.end() && knot->travel_m < last.travel_m;
         ++knot) {
        inside.push_back(*knot);
    }
    inside.push_back(last);
    return inside;
}

bool is_straight(std::span<const PathSample> knots) {
    const auto& a = knots.front();
    const auto& b = knots.back();
    const double slope = (b.along_m - a.along_m) / (b.travel_m - a.travel_m);
    return std::all_of(knots.begin(), knots.end(), [&](const PathSample& knot) {
        return std::abs(a.along_m + slope * (knot.travel_m - a.travel_m) - knot.along_m) <=
               straight_m;
    });
}

/// Counts the first knots that one straight line fits; at least two.
std::size_t straight_count(std::span<const PathSample> knots) {
    std::size_t good = 2;
    std::size_t step = 1;
    while (good < knots.size()) { // growing steps, then bisection
        const auto tried = std::min(good + step, knots.size());
        if (is_straight(knots.first(tried))) {
            good = tried;
            step *= 2;
        } else if (tried == good + 1) {
            break;
        } else {
            step = std::max<std::size_t>(1, (tried - good) / 2);
        }
    }
    return good;
}

double worst_sd_m(std::span<const PathSample> knots) {
    return std::ranges::max(knots, {}, &PathSample::sd_m).sd_m;
}

void add_leg(MatchedTrace& trace,
             const PathInterval& interval,
             const std::vector<PathSample>& knots,
             const Odometer& odometer) {
    auto rest = std::span{knots};
    const auto offset_m = [&](const PathSample& knot) {
        return std::clamp(
            interval.from_m + knot.along_m - interval.start_m, interval.from_m, interval.to_m);
    };
    while (rest.size() >= 2) {
        const auto count = straight_count(rest);
        const auto& from = rest.front();
        const auto& to = rest[count - 1];
        if (from.travel_m < to.travel_m) {
            trace.push_back({IntervalKind::road,
                             interval.edge,
                             from.travel_m,
                             to.travel_m,
                             offset_m(from),
                             offset_m(to),
                             odometer.t_s(from.travel_m),
                             odometer.t_s(to.travel_m),
                             interval.confidence,
                             "",
                             worst_sd_m(rest.first(count))});
        }
        rest = rest.subspan(count - 1);
    }
}

MatchedTrace
pieces_of(const RoadPath& path, const std::vector<PathSample>& knots, const Odometer& odometer) {
    MatchedTrace pieces;
    for (const auto& interval : path.intervals) {
        add_leg(
            pieces,
            interval,
            clipped(knots, interval.start_m, interval.start_m + interval.to_m - interval.from_m),
            odometer);
    }
    return pieces;
}

/// Fills the trace up to `to_travel_m` where there is no road.
void fill(MatchedTrace& trace,
          IntervalKind kind,
          double to_travel_m,
          const std::string& reason,
          double from_travel_m,
          const Odometer& odometer) {
    const double from_m = trace.empty() ? from_travel_m : trace.back().to_travel_m;
    if (from_m < to_travel_m) {
        trace.push_back({kind,
                         EdgeId{},
                         from_m,
                         to_travel_m,
                         0,
                         0,
                         odometer.t_s(from_m),
                         odometer.t_s(to_travel_m),
                         0,
                         reason});
    }
}

} // namespace

TripMatch map_match(const TripLog& trip,
                    const Odometer& odometer,
                    const RoadNetwork& roads,
                    const MatchConfig& config,
                    const Heading& heading) {
    auto positions = positions_of(trip, odometer, heading, config);
    TripMatch match{.trace = {}, .fixes = std::move(positions.use)};
    if (positions.samples.empty()) {
        return match;
    }
    CandidateIndex plane{roads, positions.frame};
    EdgeRouter routes{roads, config.u_turn_cost_m};
    const auto chain = viterbi_path(roads, plane, routes, positions, config);
    const auto paths = paths_of(roads, plane, routes, positions, chain, config);

    const double begin_m = positions.all.front().travel_m;
    const double end_m = positions.all.back().travel_m;
    auto& trace = match.trace;
    std::size_t sample = 0; // up to which the trace is filled
    for (const auto& path : paths) {
        auto pieces =
            pieces_of(path, smoothed_knots(path, roads, plane, positions, odometer), odometer);
        if (pieces.empty()) {
            continue;
        }
        const auto hole = hole_between(positions, chain, sample, path.first_sample, config);
        fill(trace, hole.kind, pieces.front().from_travel_m, hole.reason, begin_m, odometer);
        trace.insert(trace.end(), pieces.begin(), pieces.end());
        sample = path.last_sample;
    }
    const auto hole = hole_between(positions, chain, sample, chain.size(), config);
    fill(trace, hole.kind, end_m, hole.reason, begin_m, odometer);
    return match;
}

} // namespace macadam
