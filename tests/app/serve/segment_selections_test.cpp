// Selections of segments, as the database changes: those that a search of all segments finds.

#include "app/serve/ogc/collections.hpp"
#include "app/serve/ogc/segment_selections.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"
#include "support/roads/town.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

constexpr int side = 14;                    // crossings of the town
constexpr std::size_t segments_a_trip = 60; // but for the first
constexpr int trips = 10;

const Collection& segments_collection() {
    return *std::ranges::find(known_collections(), "segments", &Collection::id);
}

ItemsQuery query_of(const std::vector<std::pair<std::string, std::string>>& parameters) {
    return parse_items_query({.method = "GET",
                              .path = "/collections/segments/items",
                              .parameters = parameters,
                              .headers = {},
                              .client = {}},
                             segments_collection().columns());
}

/// Query for all segments that counts those that it looks at.
ItemsQuery query_that_counts(std::size_t& looked_at) {
    auto query = query_of({});
    query.tests.emplace_back([&](const Feature& /*feature*/) {
        ++looked_at;
        return true;
    });
    return query;
}

/// A town whose first trip leaves out some of its segments; later ones drive over a part.
struct DrivenTown {
    explicit DrivenTown(const std::filesystem::path& file, int first_number = 0)
        : store{RoadStore::create(file, roads, {})}, number{first_number} {
        drive(0, keys.size());
    }

    void drive_somewhere() {
        const auto from = static_cast<std::size_t>(number) * 997 % (keys.size() - segments_a_trip);
        drive(from, from + segments_a_trip);
    }

    void drive(std::size_t from, std::size_t past) {
        auto pass = passes_of(number).front();
        std::vector<Pass> passes;
        for (auto i = from; i < past; ++i) {
            if (past - from > segments_a_trip && i % 9 == 8) {
                continue;
            }
            pass.segment = keys[i];
            pass.iri_um =
                static_cast<IriUm>(900 + (37 * i + 411 * static_cast<std::size_t>(number)) % 2000);
            passes.push_back(pass);
        }
        ASSERT_TRUE(add_trip(store, trip_record(number), passes));
        store.importer.refresh();
        ++number;
    }

    std::string last_trip() const { return trip_record(number - 1).sha256; }

    RoadNetwork roads = made_up_town(side);
    std::vector<SegmentKey> keys = keys_of(roads);
    RoadStore store;
    int number;
};

/// Selects by what has been selected before, and anew.
class TwoWays {
public:
    /// Expects both to be equal. \returns the number of segments.
    std::size_t expect_equal(const StoreReader& store, const ItemsQuery& query) {
        const auto version = std::to_string(++version_);
        const auto kept = kept_.keys(store, version, query);
        EXPECT_EQ(*kept, *SegmentSelections{}.keys(store, version, query)) << query.selection;
        return kept->size();
    }

private:
    SegmentSelections kept_;
    int version_ = 0;
};

TEST(SegmentSelections, AreThoseOfASearchOfAllSegmentsAfterEachTrip) {
    DrivenTown town{test_folder() / "roads.gpkg"};
    ASSERT_GT(town.keys.size(), 2000U);
    const StoreReader& reader = town.store;
    const auto all = query_of({});
    const auto rough = query_of({{"filter", "iri > 1.9"}});
    const auto box = reader.map_box();
    const auto half =
        query_of({{"bbox",
                   std::to_string(box.west_deg) + "," + std::to_string(box.south_deg) + "," +
                       std::to_string((box.west_deg + box.east_deg) / 2) + "," +
                       std::to_string(box.north_deg)}});
    TwoWays both;
    const auto first = both.expect_equal(reader, all);
    ASSERT_GT(first, 0U);
    for (int i = 0; i < trips; ++i) {
        town.drive_somewhere();
        EXPECT_GE(both.expect_equal(reader, all), first);
        EXPECT_GT(both.expect_equal(reader, rough), 0U);
        EXPECT_LT(both.expect_equal(reader, half), first);
    }
    EXPECT_GT(both.expect_equal(reader, all), first); // segments that the first trip left out
    town.store.maintenance.forget({.trips = {town.last_trip()}, .vehicles = {}});
    both.expect_equal(reader, all);
    both.expect_equal(reader, rough);
    town.store.maintenance.calibrate();
    both.expect_equal(reader, rough);
}

TEST(SegmentSelections, LookOnlyAtWhatHasChanged) {
    DrivenTown town{test_folder() / "roads.gpkg"};
    std::size_t looked_at = 0;
    const auto query = query_that_counts(looked_at);
    SegmentSelections selections;
    const auto before = selections.keys(town.store, "a", query);
    const auto of_all = std::exchange(looked_at, 0);
    ASSERT_EQ(of_all, before->size());
    EXPECT_EQ(selections.keys(town.store, "a", query), before);
    EXPECT_EQ(looked_at, 0U);
    town.drive_somewhere();
    selections.keys(town.store, "b", query);
    EXPECT_GE(looked_at, segments_a_trip);
    EXPECT_LT(looked_at, of_all / 4);
}

TEST(SegmentSelections, AreReadyForAVersionIfTheyWereAskedOfTheOneBefore) {
    DrivenTown town{test_folder() / "roads.gpkg"};
    std::size_t looked_at = 0;
    const auto query = query_that_counts(looked_at);
    SegmentSelections selections;
    selections.keys(town.store, "a", query);
    town.drive_somewhere();
    looked_at = 0;
    selections.prepare(town.store, "b");
    EXPECT_GE(looked_at, segments_a_trip);
    looked_at = 0;
    const auto ready = selections.keys(town.store, "b", query);
    EXPECT_EQ(looked_at, 0U);
    EXPECT_EQ(*ready, *SegmentSelections{}.keys(town.store, "b", query_of({})));
    town.drive_somewhere();
    selections.prepare(town.store, "c"); // asked of "b", but nobody asks of "c"
    town.drive_somewhere();
    looked_at = 0;
    selections.prepare(town.store, "d");
    EXPECT_EQ(looked_at, 0U);
}

TEST(SegmentSelections, AreAllOfAFileThatTookThePlaceOfAnother) {
    const auto folder = test_folder();
    TwoWays both;
    const auto query = query_of({{"filter", "iri > 1.9"}});
    std::size_t first = 0;
    {
        DrivenTown town{folder / "roads.gpkg"};
        first = both.expect_equal(town.store, query);
    }
    {
        DrivenTown other{folder / "other.gpkg", 1};
        other.drive_somewhere();
    }
    for (const std::string suffix : {"", ".key"}) {
        std::filesystem::rename(folder / ("other.gpkg" + suffix), folder / ("roads.gpkg" + suffix));
    }
    EXPECT_NE(both.expect_equal(StoreReader::open(folder / "roads.gpkg"), query), first);
}

} // namespace
} // namespace macadam::testing
