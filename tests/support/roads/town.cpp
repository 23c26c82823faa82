#include "town.hpp"
#include "mapping/network/build_network.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double lat_m = 111400; // metres per degree, about, there
constexpr double lon_m = 56980;

/// How many times as long a degree of longitude is at another latitude.
double stretch_at(double lat_deg) {
    const auto cosine = [](double deg) { return std::cos(deg * std::numbers::pi / 180); };
    return cosine(lat_deg) / cosine(town_corner.lat_deg);
}

GeoPoint moved(const GeoPoint& place, double east_m, double north_m, double stretch = 1) {
    return {place.lat_deg + north_m / lat_m, place.lon_deg + east_m / (lon_m * stretch)};
}
constexpr double lane_m = 2.5; // to the right of the map's line
constexpr double odometer_scale = 1.005;

} // namespace

RoadNetwork made_up_town(int side, const GeoPoint& corner) {
    const double stretch = stretch_at(corner.lat_deg);
    std::mt19937_64 random{3};
    std::uniform_real_distribution<double> shift{-25, 25};
    std::vector<GeoPoint> crossings;
    for (int i = 0; i < side * side; ++i) {
        crossings.push_back(moved(corner,
                                  110.0 * (i % side) + shift(random),
                                  110.0 * (i / side) + shift(random),
                                  stretch));
    }
    std::vector<Way> ways;
    const auto add = [&](int a, int b) {
        const auto id = static_cast<std::int64_t>(ways.size() + 1);
        auto middle = moved(between(crossings[a], crossings[b], 0.5),
                            shift(random) / 2,
                            shift(random) / 2,
                            stretch);
        ways.push_back({id,
                        "",
                        "",
                        id % 5 == 0 ? Oneway::forward : Oneway::no,
                        {a, 1000000 + id, b},
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

Journey wander(const RoadNetwork& roads, std::size_t edges, std::mt19937_64& random) {
    for (;;) {
        Journey journey{{drivable_edges(roads)[random() % drivable_edges(roads).size()]}, {0}};
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
        const double gone_m = i * scenario.fix_step_s * journey_speed_mps;
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
    for (int i = 0; scenario.speeds && i * 0.1 * journey_speed_mps < journey.start_m.back() + 10;
         ++i) {
        trip.speed.t_s.push_back(i * 0.1);
        trip.speed.speed_mps.push_back(static_cast<float>(journey_speed_mps * odometer_scale));
    }
    return trip;
}

std::vector<SegmentKey> keys_of(const RoadNetwork& roads) {
    std::vector<SegmentKey> keys;
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        for (const bool forward : {true, false}) {
            if (const auto edge = edge_of(LinkId{i}, forward); is_drivable(roads, edge)) {
                for (const auto& segment : segments_of(roads, edge)) {
                    keys.push_back(segment.key);
                }
            }
        }
    }
    return keys;
}

} // namespace macadam::testing
