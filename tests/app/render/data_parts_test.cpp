#include "app/render/data_parts.hpp"

#include "mapping/network/build_network.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::SizeIs;

/// Two roads of 200 m, 22 km apart, and no names of places.
RoadNetwork far_roads() {
    std::vector<Way> roads;
    for (const std::int64_t number : {1, 2}) {
        const double lat_deg = 48 + 0.2 * double(number);
        Way way{.id = number,
                .name = "",
                .highway = "residential",
                .node_ids = {2 * number, 2 * number + 1},
                .line = {{lat_deg, 15}, {lat_deg + 0.0018, 15}}};
        roads.push_back(way);
    }
    return build_network(std::move(roads), 20);
}

/// Creates a database of the far roads, of which the southern one has more measurements.
StoreReader measured_far_roads() {
    const auto file = test_folder() / "roads.gpkg";
    {
        auto store = RoadStore::create(file, far_roads(), settings());
        auto passes = passes_of(0);
        for (auto far : passes_of(1)) {
            far.segment.way_id = 2;
            if (far.segment.index < 5) { // so that this is the lesser part
                passes.push_back(far);
            }
        }
        add_trip(store, trip_record(0), passes);
        store.importer.refresh();
    }
    return StoreReader::open(file);
}

TEST(DataParts, HaveLettersWhereNoPlaceNamesThem) {
    const auto store = measured_far_roads();
    MapScene scene;
    scene.box = store.map_box();
    set_insets(store, {}, scene);
    ASSERT_THAT(scene.insets, SizeIs(1));
    EXPECT_EQ(scene.insets[0].name, "A");
    EXPECT_GT(scene.insets[0].box.south_deg, scene.box.north_deg);
}

TEST(DataParts, AreNotShownAgainInDetailWhereAMapOfOneRoadNamesAllAlready) {
    const auto store = measured_far_roads();
    MapScene scene;
    scene.box = store.map_box();
    DetailRoom room{.count = 1, .scale_denominator = 2500, .width_m = 300, .height_m = 200};
    set_details(store, {}, room, scene);
    EXPECT_THAT(scene.insets, SizeIs(0));
    room.scale_denominator = 25'000;
    set_details(store, {}, room, scene);
    EXPECT_THAT(scene.insets, SizeIs(1));
}

TEST(DataParts, AreInTheMiddleOfASheetThatIsTooSmallForAll) {
    const auto store = measured_far_roads();
    MapScene scene;
    scene.box = store.map_box();
    auto whole = scene;
    const DetailRoom small{
        .count = 1, .scale_denominator = 5000, .width_m = 1000, .height_m = 1000};
    ASSERT_TRUE(centre_on_densest_area(store, {}, small, scene));
    const GeoPoint south{48.2009, 15}; // with most passes; in the middle of all is no road
    EXPECT_TRUE(contains(scene.box, south));
    EXPECT_NEAR((scene.box.south_deg + scene.box.north_deg) / 2, south.lat_deg, 0.001);
    const DetailRoom large{
        .count = 1, .scale_denominator = 1e6, .width_m = 50'000, .height_m = 50'000};
    EXPECT_FALSE(centre_on_densest_area(store, {}, large, whole)); // all is on it
}

} // namespace
} // namespace macadam::testing
