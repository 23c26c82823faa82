// How near to the truth trips alone draw roads. A program of its own, to be read as much as passed:
// it prints what it measured.

#include "estimator/motion/make_odometer.hpp"
#include "mapping/inference/network_inference.hpp"

#include "mapping/matching/map_match.hpp"
#include "mapping/network/build_network.hpp"
#include "support/roads/sensed_car.hpp"
#include "support/roads/town.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <set>

namespace macadam {
namespace {

using testing::CarConfig;
using testing::sensed;
using testing::Sensors;

constexpr GeoPoint corner{45.75, 4.85};
constexpr double m_per_deg_lat = 111150; // about, here
constexpr double m_per_deg_lon = 77830;

double length_of(const std::vector<GeoPoint>& line) {
    double sum_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum_m += distance_m(line[i - 1], line[i]);
    }
    return sum_m;
}

double drawn_m(const std::vector<Way>& ways) {
    double sum_m = 0;
    for (const auto& way : ways) {
        sum_m += length_of(way.line);
    }
    return sum_m;
}

/// A winding road of 4 km, radii from 130 m.
PointEn winding_at(double x_m) {
    return {x_m, 60 * std::sin(x_m / 200) + 30 * std::sin(x_m / 90)};
}

/// 2 m to the right of it, where the cars drive.
PointEn lane_at(double x_m) {
    const auto a = winding_at(x_m - 1);
    const auto b = winding_at(x_m + 1);
    const double long_m = std::hypot(b.east_m - a.east_m, b.north_m - a.north_m);
    const auto at = winding_at(x_m);
    return {at.east_m + 2 * (b.north_m - a.north_m) / long_m,
            at.north_m - 2 * (b.east_m - a.east_m) / long_m};
}

std::vector<GeoPoint> winding_road() {
    std::vector<GeoPoint> line;
    for (int x_m = 0; x_m <= 4000; x_m += 5) {
        const auto at = winding_at(x_m);
        line.push_back({corner.lat_deg + at.north_m / m_per_deg_lat,
                        corner.lon_deg + at.east_m / m_per_deg_lon});
    }
    return line;
}

double from_lane_m(const GeoPoint& point) {
    const PointEn at{(point.lon_deg - corner.lon_deg) * m_per_deg_lon,
                     (point.lat_deg - corner.lat_deg) * m_per_deg_lat};
    double min_m = 1e9;
    for (double x_m = at.east_m - 25; x_m <= at.east_m + 25; x_m += 0.5) {
        const auto lane = lane_at(x_m);
        min_m = std::min(min_m, std::hypot(lane.east_m - at.east_m, lane.north_m - at.north_m));
    }
    return min_m;
}

struct Drawn {
    double rms_m; ///< of the way's points from the lane, the last 100 m at either end left out
    double length_share;
};

Drawn winding_road_of(int trips, double sd_m) {
    const auto line = winding_road();
    double squares = 0;
    double count = 0;
    double share = 0;
    constexpr int repeats = 5;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        std::vector<TripLog> logs;
        for (int i = 0; i < trips; ++i) {
            CarConfig car{.noise_m = sd_m};
            car.seed = static_cast<std::uint64_t>(1000 * repeat + i + 1);
            logs.push_back(sensed(line, Sensors::positions, car));
        }
        const auto ways = trace_network(logs, TraceConfig{});
        share += drawn_m(ways) / length_of(line) / repeats;
        for (const auto& way : ways) {
            for (const auto& point : way.line) {
                const bool inside =
                    distance_m(point, line.front()) > 100 && distance_m(point, line.back()) > 100;
                squares += inside ? std::pow(from_lane_m(point), 2) : 0;
                count += inside ? 1 : 0;
            }
        }
    }
    const Drawn drawn{std::sqrt(squares / count), share};
    std::printf("sd %g m, %d trips: the road lies %.2f m (rms) off its lane, %.3f of its length\n",
                sd_m,
                trips,
                drawn.rms_m,
                drawn.length_share);
    return drawn;
}

TEST(TraceAccuracy, GrowsWithTheRootOfTheTrips) {
    for (const double sd_m : {3.0, 6.0}) {
        for (const int trips : {1, 4, 16, 64}) {
            const auto drawn = winding_road_of(trips, sd_m);
            // The trimmed mean costs 7 %, corners and ends some centimetres, the luck of 5 draws 20
            // %.
            EXPECT_LT(drawn.rms_m, 1.3 * sd_m / std::sqrt(trips) + 0.2);
            EXPECT_NEAR(drawn.length_share, 1, 0.03) << "no road twice";
        }
    }
}

/// Trips at random through a town, the roads that they draw, and the same trips on those.
struct TownDrawn {
    double length_share; ///< drawn over driven, each street and direction once
    double matched_share;
};

TownDrawn town_of(std::size_t trips, double sd_m) {
    const auto town = testing::made_up_town(6);
    std::mt19937_64 random{5};
    std::set<EdgeId> driven;
    std::vector<TripLog> logs;
    for (std::size_t i = 0; i < trips; ++i) {
        std::vector<GeoPoint> line;
        for (const auto edge : testing::wander(town, 30, random).edges) {
            const auto part = line_of(town, edge);
            line.insert(line.end(), part.begin() + (line.empty() ? 0 : 1), part.end());
            driven.insert(edge);
        }
        CarConfig car{.noise_m = sd_m};
        car.seed = i + 1;
        logs.push_back(sensed(line, Sensors::odometer, car));
    }
    double driven_m = 0;
    for (const auto edge : driven) {
        driven_m += length_m(town, edge);
    }
    const auto begin = std::clock();
    const auto ways = trace_network(logs, TraceConfig{});
    const double took_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    const auto roads = build_network(ways);
    double on_road_m = 0;
    double all_m = 0;
    for (const auto& log : logs) {
        const auto odometer = make_odometer(log, {}).odometer;
        for (const auto& piece : map_match(log, odometer, roads, {}).trace) {
            const double piece_m = piece.to_travel_m - piece.from_travel_m;
            on_road_m += piece.kind == IntervalKind::road ? piece_m : 0;
            all_m += piece_m;
        }
    }
    const TownDrawn drawn{drawn_m(ways) / driven_m, on_road_m / all_m};
    std::printf("town, sd %g m, %zu trips of %.0f km in all: drawn in %.1f s of computing, %.2f of "
                "the streets' "
                "length, %.4f of the trips matched to it\n",
                sd_m,
                trips,
                all_m / 1000,
                took_s,
                drawn.length_share,
                drawn.matched_share);
    return drawn;
}

TEST(TraceAccuracy, OfATownCarriesTheTripsThatDrewIt) {
    for (const std::size_t trips : {5, 50, 200}) {
        const auto drawn = town_of(trips, 3);
        EXPECT_GT(drawn.matched_share, 0.985);
        EXPECT_LT(drawn.length_share, 1.2); // lanes for turning at each crossing, no street twice
        EXPECT_GT(drawn.length_share, 0.95);
    }
    EXPECT_GT(town_of(100, 6).matched_share, 0.985);
}

} // namespace
} // namespace macadam
