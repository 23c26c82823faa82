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

TEST(DataParts, HaveLettersWhereNoPlaceNamesThem) {
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
    const auto store = StoreReader::open(file);
    MapScene scene;
    scene.box = store.map_box();
    set_insets(store, {}, scene);
    ASSERT_THAT(scene.insets, SizeIs(1));
    EXPECT_EQ(scene.insets[0].name, "A");
    EXPECT_GT(scene.insets[0].box.south_deg, scene.box.north_deg);
}

} // namespace
} // namespace macadam::testing
