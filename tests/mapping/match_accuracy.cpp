// How well matching does on trips whose truth is known, in a town made for it. A program of its
// own, to be read as much as passed: it prints what it measured.

#include "mapping/map_match.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>

namespace macadam {
namespace {

constexpr int side = 14; // crossings
constexpr GeoPoint corner{59.3, 18.0};
constexpr double lat_m = 111400; // metres per degree, about, here
constexpr double lon_m = 56980;

GeoPoint moved(const GeoPoint& place, double east_m, double north_m) {
    return {place.lat_deg + north_m / lat_m, place.lon_deg + east_m / lon_m};
}

/// A town: crossings about 110 m apart and out of line, streets with a bend, a fifth oneway.
RoadNetwork town() {
    std::mt19937_64 random{3};
    std::uniform_real_distribution<double> shift{-25, 25};
    std::vector<GeoPoint> crossings;
    for (int i = 0; i < side * side; ++i) {
        crossings.push_back(
            moved(corner, 110.0 * (i % side) + shift(random), 110.0 * (i / side) + shift(random)));
    }
    std::vector<Way> ways;
    const auto add = [&](int a, int b) {
        const auto id = static_cast<std::int64_t>(ways.size() + 1);
        auto middle =
            moved(between(crossings[a], crossings[b], 0.5), shift(random) / 2, shift(random) / 2);
        ways.push_back({id,
                        "",
                        "",
                        id % 5 == 0 ? Oneway::forward : Oneway::no,
                        {a, 10000 + id, b},
                        {crossings[a], middle, crossings[b]}});
    };
    for (int i = 0; i < side * side; ++i) {
        if (i % side + 1 < side) {
            add(i, i + 1);
        }
        if (i / side + 1 < side) {
            add(i, i + side);
        }
    }
    return build_network(ways);
}

struct Journey {
    std::vector<EdgeId> edges;
    std::vector<double> start_m; ///< per edge, and the whole
};

/// At random, never back at once.
Journey wander(const RoadNetwork& roads, std::size_t edges, std::mt19937_64& random) {
    for (;;) {
        Journey journey{{roads.out_edges[random() % roads.out_edges.size()]}, {0}};
        while (journey.edges.size() < edges) {
            const auto last = journey.edges.back();
            std::vector<EdgeId> next;
            for (const auto edge : out_edges(roads, to_node(roads, last))) {
                if (edge != reversed(last)) {
                    next.push_back(edge);
                }
            }
            if (next.empty()) {
                break;
            }
            journey.edges.push_back(next[random() % next.size()]);
        }
        if (journey.edges.size() == edges) {
            for (const auto edge : journey.edges) {
                journey.start_m.push_back(journey.start_m.back() + length_m(roads, edge));
            }
            return journey;
        }
    }
}

struct Scenario {
    double sd_m; ///< of a position, per axis; alike for 30 s
    double fix_step_s;
    bool speeds;
};

constexpr double speed_mps = 12;
constexpr double lane_m = 2.5; // to the right of the map's line
constexpr double odometer_scale = 1.005;

TripLog recorded(const RoadNetwork& roads,
                 const Journey& journey,
                 const Scenario& scenario,
                 std::mt19937_64& random) {
    std::normal_distribution<double> normal{0, 1};
    const double keep = std::exp(-scenario.fix_step_s / 30);
    const auto unknown = std::numeric_limits<float>::quiet_NaN();
    double east_m = scenario.sd_m * normal(random);
    double north_m = scenario.sd_m * normal(random);
    TripLog trip;
    std::size_t k = 0;
    for (int i = 0;; ++i) {
        const double gone_m = i * scenario.fix_step_s * speed_mps;
        if (gone_m >= journey.start_m.back()) {
            break;
        }
        while (gone_m >= journey.start_m[k + 1]) {
            ++k;
        }
        const auto here = place_on(roads, journey.edges[k], gone_m - journey.start_m[k]);
        const auto ahead = place_on(roads, journey.edges[k], gone_m - journey.start_m[k] + 2);
        const double right_rad = (course_deg(here, ahead) + 90) * std::numbers::pi / 180;
        east_m = keep * east_m + std::sqrt(1 - keep * keep) * scenario.sd_m * normal(random);
        north_m = keep * north_m + std::sqrt(1 - keep * keep) * scenario.sd_m * normal(random);
        trip.fixes.push_back({i * scenario.fix_step_s,
                              moved(here,
                                    lane_m * std::sin(right_rad) + east_m,
                                    lane_m * std::cos(right_rad) + north_m),
                              unknown,
                              unknown,
                              unknown});
    }
    for (int i = 0; scenario.speeds && i * 0.1 * speed_mps < journey.start_m.back() + 10; ++i) {
        trip.speed.t_s.push_back(i * 0.1);
        trip.speed.speed_mps.push_back(static_cast<float>(speed_mps * odometer_scale));
    }
    return trip;
}

struct Score {
    double right_edge; ///< share of the length
    double median_m;   ///< error along the edge, where the edge is right
    double p95_m;
};

/// Goes along the truth in steps of time, which odometers do not change.
Score score_of(const Scenario& scenario) {
    const auto roads = town();
    std::mt19937_64 random{11};
    std::vector<double> errors_m;
    double right = 0;
    double all = 0;
    for (int journeys = 0; journeys < 12; ++journeys) {
        const auto journey = wander(roads, 60, random);
        const auto trip = recorded(roads, journey, scenario, random);
        auto use = unused(trip);
        const auto odometer = make_odometer(trip, {}, use);
        const auto trace = map_match(trip, odometer, roads, {}, use);
        std::size_t piece = 0;
        for (std::size_t k = 0; k < journey.edges.size(); ++k) {
            for (double gone_m = journey.start_m[k]; gone_m < journey.start_m[k + 1]; gone_m += 5) {
                const double t_s = gone_m / speed_mps;
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
                if (p.kind == PieceKind::road && p.edge == journey.edges[k]) {
                    ++right;
                    errors_m.push_back(std::abs(offset_m - place_m));
                } else {
                    right += at_crossing && p.kind == PieceKind::road ? 1 : 0;
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
