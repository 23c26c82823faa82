#include "storage/networks/background/sea_assembly.hpp"

#include "storage/networks/osm_reader.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace macadam {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr GeoBox bounds{.west_deg = 0, .south_deg = 0, .east_deg = 10, .north_deg = 10};
constexpr GeoBox room{.west_deg = -1, .south_deg = -1, .east_deg = 11, .north_deg = 11};

using Place = std::array<double, 2>; // degrees to the east and to the north

PackedPoint packed_place(const Place& place) {
    return packed({place[1], place[0]});
}

/// A way from node `first` on, each node one more; the last is `last` if it is given.
PlacedWay coast(std::int64_t first, const std::vector<Place>& places, std::int64_t last = 0) {
    PlacedWay way{first, {}, {}};
    for (const auto& place : places) {
        way.nodes.push_back(first++);
        way.points.push_back(packed_place(place));
    }
    if (last != 0) {
        way.nodes.back() = last;
    }
    return way;
}

/// A closed way.
PlacedWay ring(std::int64_t first, std::vector<Place> places) {
    places.push_back(places.front());
    return coast(first, places, first);
}

std::vector<Place> square(double west, double south, double side) {
    return {{west, south}, {west + side, south}, {west + side, south + side}, {west, south + side}};
}

bool is_within(const std::vector<PackedPoint>& ring, const PackedPoint& at) {
    bool is_in = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto& a = ring[i];
        const auto& b = ring[(i + 1) % ring.size()];
        if ((a.lat_e7 > at.lat_e7) != (b.lat_e7 > at.lat_e7) &&
            at.lon_e7 < a.lon_e7 + double(at.lat_e7 - a.lat_e7) / (double(b.lat_e7) - a.lat_e7) *
                                       (double(b.lon_e7) - a.lon_e7)) {
            is_in = !is_in;
        }
    }
    return is_in;
}

bool is_sea(const Sea& sea, const Place& place) {
    return std::ranges::any_of(sea.areas, [&](const auto& rings) {
        return std::ranges::count_if(
                   rings, [&](const auto& each) { return is_within(each, packed_place(place)); }) %
                   2 ==
               1;
    });
}

TEST(SeaAssembly, LiesOnTheRightOfACoastAcrossTheBoundsAndGoesOnBeyondThem) {
    const std::vector<PlacedWay> southern{coast(1, {{-1, 4}, {5, 6}, {11, 4}})}; // to the east
    const auto sea = assemble_sea(southern, bounds, room);
    EXPECT_FALSE(sea.is_broken);
    ASSERT_THAT(sea.areas, SizeIs(1));
    EXPECT_TRUE(is_sea(sea, {5, 5.9}));
    EXPECT_FALSE(is_sea(sea, {5, 6.1}));
    EXPECT_TRUE(is_sea(sea, {5, -0.9}));
    EXPECT_TRUE(is_sea(sea, {-0.9, -0.9}));
    EXPECT_TRUE(is_sea(sea, {10.9, 4.2})); // as at the edge, where the coast is at 4.33
    EXPECT_FALSE(is_sea(sea, {10.9, 4.5}));
    EXPECT_FALSE(is_sea(sea, {10.9, 10.9}));
}

TEST(SeaAssembly, EndsAtTheBoundsWhereItIsNarrow) {
    const std::vector<PlacedWay> harbour{coast(1, {{4.5, -1}, {4.5, 3}, {5, 3}, {5, -1}})};
    const auto sea = assemble_sea(harbour, bounds, room);
    EXPECT_FALSE(sea.is_broken);
    EXPECT_TRUE(is_sea(sea, {4.75, 0.1}));
    EXPECT_FALSE(is_sea(sea, {4.75, -0.1}));
}

TEST(SeaAssembly, JoinsWaysInAnyOrder) {
    const std::vector<PlacedWay> coasts{coast(20, {{6, 5}, {11, 5}}),
                                        coast(1, {{-1, 5}, {3, 5}}, 10),
                                        coast(10, {{3, 5}, {3, 7}, {6, 7}, {6, 5}}, 20)};
    const auto sea = assemble_sea(coasts, bounds, room);
    ASSERT_THAT(sea.areas, SizeIs(1));
    EXPECT_TRUE(is_sea(sea, {4, 6}));
    EXPECT_FALSE(is_sea(sea, {2, 6}));
}

TEST(SeaAssembly, SurroundsIslandsAndFillsLagoonsWithin) {
    auto lagoon = square(4.4, 4.4, 0.2);
    std::ranges::reverse(lagoon); // clockwise: land outside
    const std::vector<PlacedWay> coasts{ring(1, square(4, 4, 1)), ring(20, lagoon)};
    const auto sea = assemble_sea(coasts, bounds, room);
    EXPECT_FALSE(sea.is_broken);
    EXPECT_TRUE(is_sea(sea, {1, 1}));
    EXPECT_TRUE(is_sea(sea, {-0.5, -0.5}));
    EXPECT_FALSE(is_sea(sea, {4.1, 4.1}));
    EXPECT_TRUE(is_sea(sea, {4.5, 4.5}));
}

TEST(SeaAssembly, PutsIslandsIntoTheSeaAroundThem) {
    const std::vector<PlacedWay> coasts{coast(1, {{-1, 2}, {11, 2}}),  // sea in the south
                                        coast(10, {{11, 8}, {-1, 8}}), // and in the north
                                        ring(20, square(5, 1, 0.5)),
                                        ring(30, square(5, 9, 0.5)),
                                        ring(40, square(5, 5, 0.5))}; // on land: none
    const auto sea = assemble_sea(coasts, bounds, room);
    ASSERT_THAT(sea.areas, SizeIs(2));
    EXPECT_THAT(sea.areas[0], SizeIs(2));
    EXPECT_THAT(sea.areas[1], SizeIs(2));
    EXPECT_FALSE(is_sea(sea, {5.2, 1.2}));
    EXPECT_FALSE(is_sea(sea, {5.2, 9.2}));
    EXPECT_FALSE(is_sea(sea, {5.2, 5.2}));
}

TEST(SeaAssembly, MovesTheBoundsToCoastsThatEndALittleInsideOfThem) {
    const std::vector<PlacedWay> coasts{coast(1, {{0.3, 5}, {9.6, 6}})};
    const auto sea = assemble_sea(coasts, bounds, room);
    EXPECT_FALSE(sea.is_broken);
    EXPECT_TRUE(is_sea(sea, {0.1, 4.9}));
    EXPECT_FALSE(is_sea(sea, {0.1, 5.1}));
    EXPECT_TRUE(is_sea(sea, {9.9, 5.9}));
    EXPECT_FALSE(is_sea(sea, {9.9, 6.1}));
}

TEST(SeaAssembly, TakesPointsThatTheFileLacksAsGaps) {
    auto across = coast(1, {{-9, 5}, {-1, 5}, {5, 5}, {11, 5}, {19, 5}});
    across.points.front() = across.points.back() = NodePositions::nowhere;
    const auto sea = assemble_sea(std::vector{across}, bounds, room);
    EXPECT_TRUE(is_sea(sea, {5, 4}));
    across.points[2] = NodePositions::nowhere; // what is left has single points
    EXPECT_THAT(assemble_sea(std::vector{across}, bounds, room).areas, IsEmpty());
}

TEST(SeaAssembly, HasNoSeaWhereACoastEndsInTheMiddle) {
    const auto sea = assemble_sea(std::vector{coast(1, {{-1, 5}, {5, 5}})}, bounds, room);
    EXPECT_TRUE(sea.is_broken);
    EXPECT_THAT(sea.areas, IsEmpty());
}

TEST(SeaAssembly, HasNoSeaWhereCoastsContradictEachOther) {
    const std::vector<PlacedWay> coasts{coast(1, {{-1, 2}, {11, 2}}),
                                        coast(10, {{-1, 8}, {11, 8}})};
    const auto sea = assemble_sea(coasts, bounds, room);
    EXPECT_TRUE(sea.is_broken);
    EXPECT_THAT(sea.areas, IsEmpty());
}

TEST(SeaAssembly, HasNeitherSeaNorBreaksWithoutACoast) {
    const auto sea = assemble_sea({}, bounds, room);
    EXPECT_FALSE(sea.is_broken);
    EXPECT_THAT(sea.areas, IsEmpty());
}

TEST(SeaAssembly, IsAllThatIsNotLandWhereverALandmassCrossesTheBounds) {
    std::mt19937 random{7};
    std::uniform_real_distribution<double> radius{1, 8};
    int seen = 0;
    for (int round = 0; round < 20; ++round) {
        std::vector<Place> shore; // counterclockwise: land inside
        for (int i = 0; i < 40; ++i) {
            const double angle = 2 * std::numbers::pi * i / 40;
            const double r = radius(random);
            shore.push_back({5 + r * std::cos(angle), 5 + r * std::sin(angle)});
        }
        const auto sea = assemble_sea(std::vector{ring(1, shore)}, bounds, room);
        ASSERT_FALSE(sea.is_broken);
        std::vector<PackedPoint> land;
        std::ranges::transform(shore, std::back_inserter(land), packed_place);
        for (double x = 0.13; x < 10; x += 0.5) {
            for (double y = 0.17; y < 10; y += 0.5) {
                EXPECT_NE(is_sea(sea, {x, y}), is_within(land, packed_place({x, y})))
                    << round << ": " << x << ", " << y;
                ++seen;
            }
        }
    }
    EXPECT_EQ(seen, 8000);
}

} // namespace
} // namespace macadam
