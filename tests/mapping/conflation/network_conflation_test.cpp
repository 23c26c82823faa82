#include "mapping/conflation/network_conflation.hpp"

#include "mapping/network/build_network.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/town.hpp"

#include <gmock/gmock.h>

#include <random>

namespace macadam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

constexpr double drawing_m = 0.1; // feet on a line that is drawn with other points

/// Its stations, to a decimetre.
auto part(std::int64_t way_id, bool forward, double from_station_m, double to_station_m) {
    return AllOf(
        Field("way_id", &DirectedPart::way_id, way_id),
        Field("forward", &DirectedPart::forward, forward),
        Field(&DirectedPart::from_station_m, ::testing::DoubleNear(from_station_m, drawing_m)),
        Field(&DirectedPart::to_station_m, ::testing::DoubleNear(to_station_m, drawing_m)));
}

template <typename Before, typename After>
auto goes(const Before& before, const After& after) {
    return AllOf(Field(&RoadCorrespondence::before, before),
                 Field(&RoadCorrespondence::after, after));
}

double length_of(const RoadNetwork& roads, std::uint32_t way) {
    return way_at(roads, way).along_m.back();
}

/// 400 m, 200 m between letters, and a side street at its middle.
testing::RoadArt street() {
    return testing::road_art(R"(
        A---------B---------C
                  |
                  D
    )",
                             20,
                             {"ABC", "BD"});
}

NetworkChange changed(const std::vector<Way>& before, const testing::EditedNetwork& after) {
    return change_between(build_network(before), build_network(testing::ways_of(after)));
}

TEST(NetworkChange, KeepsAllOfTheSameNetwork) {
    const auto art = street();
    const auto change = change_between(art.roads, art.roads);
    EXPECT_THAT(change.kept, ElementsAre(1, 2));
    EXPECT_THAT(change.same, IsEmpty());
}

TEST(NetworkChange, FollowsAWayThatWasSplit) {
    const auto art = street();
    auto after = testing::edited(art.ways);
    testing::split(after, 1, 1, 9);
    const double half_m = length_of(art.roads, 0) / 2;
    const auto change = changed(art.ways, after);
    EXPECT_THAT(change.kept, ElementsAre(2));
    EXPECT_THAT(change.same,
                ElementsAre(goes(part(1, true, 0, half_m), part(1, true, 0, half_m)),
                            goes(part(1, true, half_m, 2 * half_m), part(9, true, 0, half_m)),
                            goes(part(1, false, -2 * half_m, -half_m), part(9, false, -half_m, 0)),
                            goes(part(1, false, -half_m, 0), part(1, false, -half_m, 0))));
}

TEST(NetworkChange, FollowsWaysThatWereMerged) {
    const auto art = testing::road_art("A---------B---------C", 20, {"AB>", "BC>"});
    auto after = testing::edited(art.ways);
    testing::merge(after, 1, 2);
    const double half_m = length_of(art.roads, 0);
    EXPECT_THAT(changed(art.ways, after).same,
                ElementsAre(goes(part(1, true, 0, half_m), part(1, true, 0, half_m)),
                            goes(part(2, true, 0, half_m), part(1, true, half_m, 2 * half_m))));
}

TEST(NetworkChange, FollowsAWayByItsPlaceWhenItsNumberIsAnother) {
    const auto art = street();
    auto after = testing::edited(art.ways);
    testing::renumber(after, 2, 77);
    const double side_m = length_of(art.roads, 1);
    EXPECT_THAT(changed(art.ways, after).same,
                ElementsAre(goes(part(2, true, 0, side_m), part(77, true, 0, side_m)),
                            goes(part(2, false, -side_m, 0), part(77, false, -side_m, 0))));
}

TEST(NetworkChange, TurnsDirectionsOfAWayThatWasDrawnTheOtherWayRound) {
    const auto art = street();
    auto after = testing::edited(art.ways);
    testing::reverse(after, 2);
    const double side_m = length_of(art.roads, 1);
    EXPECT_THAT(changed(art.ways, after).same,
                ElementsAre(goes(part(2, true, 0, side_m), part(2, false, -side_m, 0)),
                            goes(part(2, false, -side_m, 0), part(2, true, 0, side_m))));
}

TEST(NetworkChange, FollowsTheOneDirectionOfAOnewayThatIsNoneAnyMore) {
    const auto before = testing::road_art("A---------B", 20, {"AB>"});
    const auto after = testing::road_art("A---------B", 20, {"AB"});
    const double whole_m = length_of(before.roads, 0);
    EXPECT_THAT(change_between(before.roads, after.roads).same,
                ElementsAre(goes(part(1, true, 0, whole_m), part(1, true, 0, whole_m))));
    EXPECT_THAT(change_between(after.roads, before.roads).same,
                ElementsAre(goes(part(1, true, 0, whole_m), part(1, true, 0, whole_m))));
}

TEST(NetworkChange, LeavesAWayWhereANewRoadOnlyMeetsIt) {
    const auto after = street();
    const auto before = build_network({after.ways[0]});
    const double whole_m = length_of(before, 0);
    EXPECT_THAT(change_between(before, after.roads).same,
                ElementsAre(goes(part(1, true, 0, whole_m), part(1, true, 0, whole_m)),
                            goes(part(1, false, -whole_m, 0), part(1, false, -whole_m, 0))));
}

/// All of the town but for some ways moves at random by this standard deviation per axis.
testing::EditedNetwork nudged(const std::vector<Way>& ways, double sd_m) {
    auto after = testing::edited(ways);
    testing::nudge(after, [sd_m](std::int64_t node_id, const GeoPoint& place) {
        std::mt19937_64 random{static_cast<std::uint64_t>(node_id)};
        std::normal_distribution<double> metres{0, sd_m};
        return GeoPoint{place.lat_deg + metres(random) / 111'200,
                        place.lon_deg + metres(random) / 56'980};
    });
    return after;
}

TEST(NetworkChange, FindsRoadsThatWereNudged) {
    const auto town = copies_of_ways(testing::made_up_town(8));
    const auto found = testing::score(town, nudged(town, 2.5));
    EXPECT_GE(found.right_m, 0.98 * (found.right_m + found.wrong_m + found.lost_m));
    EXPECT_LE(found.wrong_m, 0.005 * found.right_m);
}

TEST(NetworkChange, LosesARoadThatWasRebuiltThirtyMetresAside) {
    const auto art = street();
    auto after = testing::edited(art.ways);
    testing::rebuild_aside(after, 2, 30, 1000);
    EXPECT_THAT(changed(art.ways, after).same,
                ElementsAre(goes(part(1, true, 0, length_of(art.roads, 0)),
                                 part(1, true, 0, length_of(art.roads, 0))),
                            goes(part(1, false, -length_of(art.roads, 0), 0),
                                 part(1, false, -length_of(art.roads, 0), 0))));
}

TEST(NetworkChange, LosesARoadThatIsGone) {
    const auto art = street();
    auto after = testing::edited(art.ways);
    testing::erase(after, 2);
    const auto same = changed(art.ways, after).same;
    ASSERT_FALSE(same.empty());
    for (const auto& road : same) {
        EXPECT_EQ(road.before.way_id, 1);
        EXPECT_EQ(road.after.way_id, 1);
    }
}

TEST(NetworkChange, TakesNoNewRoadBesideForTheOldOne) {
    for (const double aside_m : {6.0, 12.0}) {
        const auto art = street();
        auto after = testing::edited(art.ways);
        testing::renumber(after, 1, 5);
        testing::add_parallel(after, 5, aside_m, 1, 1000); // which even has the old one's number
        const auto found = testing::score(art.ways, after);
        EXPECT_EQ(found.wrong_m, 0) << aside_m;
        EXPECT_EQ(found.lost_m, 0) << aside_m;
    }
}

/// Two carriageways of one direction, 8 m apart, of which the right one has a side street.
testing::RoadArt carriageways() {
    auto art = testing::road_art(R"(
        A---------B---------C
        D---------E---------F
                  |
                  |
                  |
                  |
                  G
    )",
                                 4,
                                 {"ABC>", "DEF>", "EG"});
    for (auto& way : art.ways) { // stretch it to the east: 400 m long, 8 m between
        for (auto& place : way.line) {
            place.lon_deg = 4.85 + (place.lon_deg - 4.85) * 5;
        }
        way.name = "Road";
    }
    return art;
}

TEST(NetworkChange, KeepsCarriagewaysApartThatWereBothMovedAside) {
    const auto art = carriageways();
    auto after = testing::edited(art.ways);
    testing::nudge(after, [](std::int64_t, const GeoPoint& place) {
        return GeoPoint{place.lat_deg - 6 / 111'200.0, place.lon_deg};
    });
    testing::renumber(after, 1, 11);
    testing::renumber(after, 2, 12);
    const auto found = testing::score(art.ways, after);
    EXPECT_EQ(found.wrong_m, 0);
    EXPECT_EQ(found.lost_m, 0);
}

TEST(NetworkChange, KnowsOneOfTwoCarriagewaysThatIsGone) {
    for (const std::int64_t gone : {1, 2}) {
        const auto art = carriageways();
        auto after = testing::edited(art.ways);
        testing::renumber(after, 3 - gone, 11);
        testing::erase(after, gone);
        const auto found = testing::score(art.ways, after);
        EXPECT_EQ(found.wrong_m, 0) << gone;
        EXPECT_EQ(found.lost_m, 0) << gone;
    }
}

TEST(NetworkChange, TellsARoadOnABridgeFromTheOneBeneathByWhatMeetsIt) {
    auto before = carriageways().ways;
    before[0].line = before[1].line; // one over the other
    auto after = testing::edited(before);
    testing::renumber(after, 1, 32);
    testing::renumber(after, 2, 31);
    const auto found = testing::score(before, after);
    EXPECT_EQ(found.wrong_m, 0);
    EXPECT_EQ(found.lost_m, 0);
}

TEST(NetworkChange, LosesACrossingThatBecameARoundabout) {
    const auto before = testing::road_art(R"(
                  N
                  |
                  |
                  |
                  |
        W---------X---------E
                  |
                  |
                  |
                  |
                  S
    )",
                                          20,
                                          {"WXE", "NXS"});
    auto ways = before.ways;
    const auto at = [&](double east_m, double north_m) {
        const auto middle = before.places.at('X');
        return GeoPoint{middle.lat_deg + north_m / 111'150, middle.lon_deg + east_m / 77'830};
    };
    constexpr double ring_m = 25;
    std::vector<Way> after;
    Way ring{100, "", "", Oneway::forward, {}, {}};
    for (const std::int64_t i : {0, 1, 2, 3, 4, 5, 6, 7, 0}) { // against the clock, from the east
        const double angle_rad = static_cast<double>(i) * 0.7853981633974483;
        ring.node_ids.push_back(1000 + i);
        ring.line.push_back(at(ring_m * std::cos(angle_rad), ring_m * std::sin(angle_rad)));
    }
    const auto arm = [&](std::int64_t id, char letter, std::int64_t corner) {
        after.push_back({id,
                         "",
                         "",
                         Oneway::no,
                         {letter, 1000 + corner},
                         {before.places.at(letter), ring.line[static_cast<std::size_t>(corner)]}});
    };
    arm(1, 'W', 4);
    arm(2, 'N', 2);
    arm(3, 'E', 0);
    arm(4, 'S', 6);
    after.push_back(ring);
    const auto change = change_between(before.roads, build_network(after));
    double found_m = 0;
    for (const auto& road : change.same) {
        EXPECT_NE(road.after.way_id, 100);
        found_m += road.before.to_station_m - road.before.from_station_m;
    }
    const double all_m = 2 * (length_of(before.roads, 0) + length_of(before.roads, 1));
    EXPECT_NEAR(found_m, all_m - 8 * ring_m, 8 * 10); // sampled each ten metres
}

} // namespace
} // namespace macadam
