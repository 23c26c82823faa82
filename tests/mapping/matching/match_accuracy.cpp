// How well matching does on trips whose truth is known, in a town made for it. A program of its
// own, to be read as much as passed: it prints what it measured.

#include "estimator/motion/make_odometer.hpp"
#include "mapping/matching/map_match.hpp"

#include "support/roads/town.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>

namespace macadam {
namespace {

using testing::journey_speed_mps;
using testing::recorded;
using testing::Scenario;

struct Score {
    double right_edge; ///< share of the length
    double median_m;   ///< error along the edge, where the edge is right
    double p95_m;
};

/// Goes along the truth in steps of time, which odometers do not change.
Score score_of(const Scenario& scenario) {
    const auto roads = testing::made_up_town(14);
    std::mt19937_64 random{11};
    std::vector<double> errors_m;
    double right = 0;
    double all = 0;
    for (int journeys = 0; journeys < 12; ++journeys) {
        const auto journey = testing::wander(roads, 60, random);
        const auto trip = recorded(roads, journey, scenario, random);
        const auto odometer = make_odometer(trip, {}).odometer;
        const auto trace = map_match(trip, odometer, roads, {}).trace;
        std::size_t piece = 0;
        for (std::size_t k = 0; k < journey.edges.size(); ++k) {
            for (double gone_m = journey.start_m[k]; gone_m < journey.start_m[k + 1]; gone_m += 5) {
                const double t_s = gone_m / journey_speed_mps;
                if (t_s > trip.fixes.back().t_s) {
                    break;
                }
                const double travel_m = odometer.travel_m(t_s);
                while (piece + 1 < trace.size() && trace[piece].to_travel_m < travel_m) {
                    ++piece;
                }
                const auto& p = trace[piece];
                const double share = std::clamp(
                    (travel_m - p.from_travel_m) / (p.to_travel_m - p.from_travel_m), 0.0, 1.0);
                const double offset_m = std::lerp(p.from_offset_m, p.to_offset_m, share);
                // The last metres before a crossing and the first after it are one place.
                const double place_m = gone_m - journey.start_m[k];
                const bool at_crossing =
                    place_m < 10 || place_m > length_m(roads, journey.edges[k]) - 10;
                if (p.kind == IntervalKind::road && p.edge == journey.edges[k]) {
                    ++right;
                    errors_m.push_back(std::abs(offset_m - place_m));
                } else {
                    right += at_crossing && p.kind == IntervalKind::road ? 1 : 0;
                }
                ++all;
            }
        }
    }
    std::sort(errors_m.begin(), errors_m.end());
    const Score score{
        right / all, errors_m[errors_m.size() / 2], errors_m[errors_m.size() * 95 / 100]};
    std::printf("sd %g m, a fix each %g s, %s: right edge %.4f, along it p50 %.2f m, p95 %.2f m\n",
                scenario.sd_m,
                scenario.fix_step_s,
                scenario.speeds ? "odometer" : "positions only",
                score.right_edge,
                score.median_m,
                score.p95_m);
    return score;
}

// The bounds are what the first form reached, with a little room: they hold what was gained.

TEST(MatchAccuracy, OfAGoodReceiverWithOdometer) {
    const auto score = score_of({3, 1, true});
    EXPECT_GT(score.right_edge, 0.995);
    EXPECT_LT(score.median_m, 2);
    EXPECT_LT(score.p95_m, 6);
}

TEST(MatchAccuracy, OfAGoodReceiverTenTimesASecond) {
    const auto score = score_of({3, 0.1, true});
    EXPECT_GT(score.right_edge, 0.995);
    EXPECT_LT(score.p95_m, 6);
}

TEST(MatchAccuracy, OfAPoorReceiverWithOdometer) {
    EXPECT_GT(score_of({10, 1, true}).right_edge, 0.97);
}

TEST(MatchAccuracy, OfPositionsAlone) {
    const auto score = score_of({3, 1, false});
    EXPECT_GT(score.right_edge, 0.99);
    EXPECT_LT(score.p95_m, 8);
}

TEST(MatchAccuracy, OfPositionsEachFiveSeconds) {
    EXPECT_GT(score_of({5, 5, false}).right_edge, 0.97);
}

} // namespace
} // namespace macadam
