// Publications of a crowd whose roads a newer map cuts otherwise.

#include "support/files/files.hpp"
#include "support/roads/crowd_drives.hpp"
#include "support/roads/store_world.hpp"

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/build_network.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using testing::day_ms;
using ::testing::Each;
using ::testing::ElementsAre;
using testing::february_ms;
using ::testing::Gt;
using ::testing::HasSubstr;
using testing::january_ms;
using ::testing::Key;
using ::testing::Lt;
using ::testing::Not;
using ::testing::Pair;
using testing::refusal_of;
using ::testing::SizeIs;
using testing::test_folder;

constexpr std::int64_t month_ms = 31 * day_ms;

constexpr int road_count = 4;

/// Four roads in a row, of which the second one is cut at 90 m, so that none of its segments stays,
/// and the third one has another number.
RoadNetwork newer_roads() {
    auto ways = copies_of_ways(testing::roads_in_a_row(road_count));
    ways.at(2).id = 30;
    auto& first = ways.at(1);
    auto second = first;
    const auto& [from, to] = std::pair{first.line.front(), first.line.back()};
    const GeoPoint cut{from.lat_deg, from.lon_deg + 0.45 * (to.lon_deg - from.lon_deg)};
    first.line.back() = second.line.front() = cut;
    first.node_ids.back() = second.node_ids.front() = 20;
    second.id = 20;
    ways.push_back(std::move(second));
    return build_network(std::move(ways));
}

/// The same with another number of the road that was cut.
RoadNetwork newest_roads() {
    auto ways = copies_of_ways(newer_roads());
    std::ranges::find(ways, 2, &Way::id)->id = 40;
    return build_network(std::move(ways));
}

class CrowdOfTwoMaps : public ::testing::Test {
protected:
    void drive(int car, std::int64_t utc_ms, IriUm iri_um) {
        auto record = testing::trip_record(1000 + trips_++);
        record.vehicle_id = "car " + std::to_string(car);
        record.t0_utc_ms = utc_ms;
        std::vector<Pass> passes;
        for (const auto way : {1, 2, 40, 20, 3, 30, 4}) {
            add_passes_of(way, iri_um, passes);
        }
        testing::add_trip(store_, record, passes);
    }
    void drive_all(int cars, std::int64_t utc_ms, IriUm iri_um) {
        for (int car = 0; car < cars; ++car) {
            drive(car, utc_ms, iri_um);
        }
        store_.importer.refresh();
    }
    std::size_t publish() {
        now_ms_ += month_ms;
        return store_.maintenance.publish(roads_, now_ms_).changed;
    }
    void update_map(RoadNetwork after = newer_roads()) {
        store_.maintenance.update_network(
            roads_, after, change_between(roads_, after), {"newer map", ""});
        roads_ = std::move(after);
    }
    /// Published values by the id of the way.
    std::map<std::int64_t, std::vector<IriUm>> seen() const {
        std::map<std::int64_t, std::vector<IriUm>> values;
        StoreReader::open(file_).visit({}, [&](const SegmentRecord& record) {
            if (record.state) {
                values[record.segment.key.way_id].push_back(record.state->iri_um);
            }
        });
        return values;
    }

    std::filesystem::path file_ = test_folder() / "crowd.gpkg";
    RoadNetwork roads_ = testing::roads_in_a_row(road_count);
    RoadStore store_ = RoadStore::create(
        file_,
        roads_,
        {.network_source = "map", .attribution = "", .privacy = PrivacyProfile::crowd});

private:
    void add_passes_of(std::int64_t way, IriUm iri_um, std::vector<Pass>& passes) const {
        for (std::uint32_t i = 0; i < link_count(roads_); ++i) {
            const auto edge = edge_of(LinkId{i}, true);
            for (const auto& segment : segments_of(roads_, edge)) {
                if (segment.key.way_id == way) {
                    auto pass = testing::passes_of(1).front();
                    pass.segment = segment.key;
                    pass.iri_left_um = pass.iri_right_um = std::nullopt;
                    pass.iri_um = iri_um;
                    pass.t_ms = 1000 * static_cast<std::int64_t>(passes.size());
                    passes.push_back(pass);
                }
            }
        }
    }

    std::int64_t now_ms_ = january_ms;
    int trips_ = 0;
};

TEST_F(CrowdOfTwoMaps, PublishesNoPassAgainThatAnEarlierMapHad) {
    drive_all(5, january_ms, 2000);
    ASSERT_EQ(publish(), 20U);
    drive(5, january_ms + day_ms, 9000); // waits, alone
    store_.importer.refresh();
    ASSERT_EQ(publish(), 0U);
    ASSERT_THAT(seen(), ElementsAre(Pair(2, SizeIs(10)), Pair(3, SizeIs(10))));
    update_map();
    // The passes of six cars lie on the new segments: published, they would tell of the sixth car
    // beside what the earlier map showed of the five.
    for (int publication = 3; publication <= 8; ++publication) {
        EXPECT_EQ(publish(), 0U) << publication;
        EXPECT_THAT(seen(), ElementsAre(Pair(30, SizeIs(10)))) << publication;
    }
    drive_all(5, january_ms + 10 * month_ms, 2100);
    EXPECT_GT(publish(), 0U);
    const auto now = seen();
    EXPECT_THAT(now.at(2), Each(2100)); // nor do values tell of the earlier passes
    EXPECT_THAT(now.at(20), Each(2100));
    EXPECT_THAT(now.at(30), Each(AllOf(Gt(2000), Lt(2100))));
    EXPECT_EQ(publish(), 0U);
    drive_all(5, january_ms + 12 * month_ms, 2200);
    EXPECT_GT(publish(), 0U);
    EXPECT_THAT(seen().at(2), Each(AllOf(Gt(2100), Lt(2200))));
}

TEST_F(CrowdOfTwoMaps, PublishesNoPassAgainThoughANewestMapRenumbersTheRoadThatWasCut) {
    drive_all(5, january_ms, 2000);
    publish();
    drive(5, january_ms + day_ms, 9000); // waits, alone
    store_.importer.refresh();
    publish();
    update_map();
    drive_all(5, january_ms + 3 * month_ms, 2100);
    publish();
    ASSERT_THAT(seen().at(2), Each(2100));
    ASSERT_THAT(seen().at(20), Each(2100));
    update_map(newest_roads());
    EXPECT_THAT(seen(), AllOf(Not(Contains(Key(40))), Contains(Key(20)), Contains(Key(30))));
    drive_all(5, january_ms + 4 * month_ms, 2200);
    publish();
    EXPECT_THAT(seen().at(40), Each(2200)); // nothing of the six cars before the first update
    EXPECT_THAT(seen().at(20), Each(AllOf(Gt(2100), Lt(2200))));
    EXPECT_THAT(seen().at(30), Each(AllOf(Gt(2000), Lt(2200)))); // was never cut
}

TEST_F(CrowdOfTwoMaps, PublishesPassesThatNoPublicationSawBefore) {
    drive_all(6, january_ms, 2000);
    update_map();
    EXPECT_GT(publish(), 0U);
    EXPECT_THAT(seen(), SizeIs(3));
}

TEST_F(CrowdOfTwoMaps, PublishesPassesOfTheMonthInWhichTheMapWasUpdated) {
    drive_all(5, january_ms, 2000);
    publish();
    drive_all(5, february_ms, 4000);
    update_map();
    EXPECT_GT(publish(), 0U);
    EXPECT_THAT(seen().at(2), Each(4000));
    EXPECT_THAT(seen(), SizeIs(3));
}

TEST_F(CrowdOfTwoMaps, IsNotPublishedOnRoadsThatWereUpdatedMeanwhile) {
    drive_all(6, january_ms, 2000);
    bool is_updated = false;
    const Progress meanwhile{
        .report =
            [&](std::size_t, std::size_t) {
                if (std::exchange(is_updated, true)) {
                    return;
                }
                const auto after = newer_roads();
                RoadStore::open(file_).maintenance.update_network(
                    roads_, after, change_between(roads_, after), {"newer map", ""});
            },
        .stop = {}};
    EXPECT_THAT(refusal_of([&] { store_.maintenance.publish(roads_, february_ms, meanwhile); }),
                HasSubstr("its roads were updated in the meantime"));
    EXPECT_TRUE(is_updated);
    EXPECT_FALSE(RoadStore::open(file_).latest_publication());
}

} // namespace
} // namespace macadam
