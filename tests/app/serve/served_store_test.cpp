// What a server shows while its database is maintained.

#include "app/serve/served_store.hpp"
#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/http/served_store.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>

namespace macadam::testing {
namespace {

constexpr std::size_t workers = 3;

std::filesystem::path new_file() {
    auto file = test_folder() / "roads.gpkg";
    auto store = new_store(file);
    import_trimmed_trips(store);
    return file;
}

/// Updates the map to one without way 3.
void update_map(const std::filesystem::path& file) {
    auto network = edited(copies_of_ways(small_country()));
    erase(network, 3);
    const auto after = build_network(ways_of(network));
    RoadStore::open(file).maintenance.update_network(
        small_country(), after, change_between(small_country(), after), {"newer.osm", "newer"});
}

std::size_t count_of_values(const StoreReader& reader) {
    std::size_t count = 0;
    reader.visit({}, [&](const SegmentRecord& /*record*/) { ++count; });
    return count;
}

TEST(ServedStore, HasNoReaderThatShowsMoreThanThePublicationsOfACrowd) {
    const auto file = new_file();
    ServedStore served{file, Audience::anyone, workers, {}};
    for (std::size_t worker = 0; worker < workers; ++worker) {
        EXPECT_EQ(count_of_values(served.reader(worker)), 20U);
    }
    RoadStore::open(file).maintenance.make_crowd();
    ASSERT_TRUE(served.look());
    for (std::size_t worker = 0; worker < workers; ++worker) {
        EXPECT_TRUE(served.reader(worker).shows_published_alone());
        EXPECT_EQ(count_of_values(served.reader(worker)), 0U);
        EXPECT_EQ(count_of_values(served.reader(worker, Audience::operator_)), 20U);
    }
}

TEST(ServedStore, ReadsTheRoadsOfAMapThatWasUpdated) {
    const auto file = new_file();
    ServedStore served{file, Audience::anyone, workers, {}};
    for (std::size_t worker = 0; worker < workers; ++worker) {
        EXPECT_EQ(way_count(served.reader(worker).roads()), 3U);
    }
    update_map(file);
    ASSERT_TRUE(served.look());
    for (std::size_t worker = 0; worker < workers; ++worker) {
        EXPECT_EQ(way_count(served.reader(worker).roads()), 2U);
    }
}

TEST(ServedStore, TakesDownWhatACrowdHasNotPublished) {
    const ServedWorld served{{.port = 0, .workers = 1}}; // whose reader has shown all
    auto store = RoadStore::open(served.file);
    import_trimmed_trips(store);
    const auto matched = [&](std::string_view id) {
        return served.page(fmt::format("/collections/{}/items", id)).at("numberMatched").get<int>();
    };
    while (matched("events") == 0) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    const auto segment = served.page("/collections/segments/items?limit=1")
                             .at("features")[0]
                             .at("id")
                             .get<std::string>();
    EXPECT_EQ(served.ask("/collections/segments/items/" + segment).status, 200);
    store.maintenance.make_crowd();
    EXPECT_EQ(count_of_values(StoreReader::open(served.file, {}, Audience::operator_)), 20U);
    while (matched("segments") > 0 || matched("events") > 0) { // likewise
        std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    EXPECT_EQ(served.ask("/collections/segments/items/" + segment).status, 404);
    EXPECT_EQ(matched("worst"), 0);
}

TEST(ServedStore, FollowsAnUpdateOfTheMap) {
    const auto table = test_folder() / "sections.csv";
    const SectionOptions sections{.route = {},
                                  .best = {},
                                  .along = {},
                                  .sections = table,
                                  .length_m = 100,
                                  .homogeneous = false,
                                  .exclude = {},
                                  .exclude_radius_m = 20};
    const ServedWorld served{{.port = 0, .workers = 1}, {}, sections};
    written(table.parent_path(), "sections.csv", "section,way_id,from_m,to_m\nhigh,1,0,200\n");
    const auto expect_lists = [&] {
        for (const auto* const id : {"worst", "sections"}) {
            EXPECT_EQ(served.ask(fmt::format("/collections/{}/items", id)).status, 200) << id;
        }
    };
    expect_lists();
    const auto etag = [&] { return served.ask("/collections").headers.at("etag"); };
    const auto before = etag();
    update_map(served.file);
    while (etag() == before) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    expect_lists();
    EXPECT_EQ(served.page("/collections/segments").at("attribution"), "newer");
}

} // namespace
} // namespace macadam::testing
