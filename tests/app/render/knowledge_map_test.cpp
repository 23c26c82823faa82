#include "app/render/knowledge_map.hpp"

#include "render/map/sheet/legend.hpp"
#include "render/scene/colour.hpp"
#include "render/scene/colour_difference.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t day_ms = 86'400'000;

SegmentState state(int passes, std::int64_t last_seen_ms, IriUm half_um) {
    SegmentState state{};
    state.iri_um = 2000;
    state.low_um = 2000 - half_um;
    state.high_um = 2000 + half_um;
    state.passes = passes;
    state.last_seen_ms = last_seen_ms;
    return state;
}

/// Twelve trips over ten segments forward, of which the first three have only two.
std::string known_roads(const std::filesystem::path& folder) {
    const auto file = (folder / "roads.gpkg").string();
    auto store = new_store(file);
    for (int number = 0; number < 12; ++number) {
        auto passes = passes_of(number);
        std::erase_if(passes, [&](const Pass& pass) {
            return !pass.segment.forward || (number >= 2 && pass.segment.index < 3);
        });
        add_trip(store, trip_record(number), passes);
    }
    store.importer.refresh();
    return file;
}

MapRequest request() {
    return {.title = "Coverage", .size = {.width_px = 800, .height_px = 600}};
}

TEST(KnowledgeMap, ClassesBeginWithWhatIsKnownBest) {
    const std::int64_t now_ms = 1000 * day_ms;
    EXPECT_EQ(class_in(Knowledge::passes, state(30, 0, 0), {}), 0U);
    EXPECT_EQ(class_in(Knowledge::passes, state(9, 0, 0), {}), 2U);
    EXPECT_EQ(class_in(Knowledge::passes, state(1, 0, 0), {}), 4U);
    EXPECT_EQ(class_in(Knowledge::passes, state(0, 0, 0), {}), std::nullopt); // references only
    EXPECT_EQ(class_in(Knowledge::age, state(1, now_ms - 20 * day_ms, 0), now_ms), 0U);
    EXPECT_EQ(class_in(Knowledge::age, state(1, now_ms - 900 * day_ms, 0), now_ms), 4U);
    EXPECT_EQ(class_in(Knowledge::age, state(1, 0, 0), {}), std::nullopt);
    EXPECT_EQ(class_in(Knowledge::confidence, state(1, 0, 200), {}), 0U); // 10 %
    EXPECT_EQ(class_in(Knowledge::confidence, state(1, 0, 201), {}), 1U);
    EXPECT_EQ(class_in(Knowledge::confidence, state(1, 0, 1300), {}), 4U);
}

TEST(KnowledgeMap, ColoursSegmentsByTheirPassesAndExplainsItself) {
    const auto store = StoreReader::open(known_roads(test_folder()));
    const auto plan = load_knowledge_map(store, request(), Knowledge::passes);
    std::array<int, 5> counts{};
    for (const auto& line : plan.scene().lines) {
        if (line.iri_class >= 0) {
            ++counts.at(std::size_t(line.iri_class));
        }
    }
    EXPECT_THAT(counts, ElementsAre(0, 7, 0, 3, 0));
    const auto legend = legend_of(plan.scene(), plan.style(), *plan.style().classes);
    EXPECT_EQ(legend.title, "Coverage");
    EXPECT_EQ(legend.entries.at(1).name, "10 – 29");
    EXPECT_EQ(legend.entries.at(1).length, "0.1 km"); // 7 segments of 20 m
    EXPECT_THAT(legend.note, HasSubstr("The more passes, the surer the value"));
}

TEST(KnowledgeMap, ShowsWhatIsInABoxToo) {
    const auto store = StoreReader::open(known_roads(test_folder()));
    auto boxed = request();
    boxed.filter.box = grown(store.info().box, 100);
    const auto plan = load_knowledge_map(store, boxed, Knowledge::confidence);
    EXPECT_EQ(std::ranges::count_if(plan.scene().lines,
                                    [](const MapLine& line) { return line.iri_class >= 0; }),
              10);
}

TEST(KnowledgeMap, HasColoursThatNobodyConfuses) {
    const auto store = StoreReader::open(known_roads(test_folder()));
    const auto plan = load_knowledge_map(store, request(), Knowledge::age);
    const auto colours = class_colours(plan.style(), 5);
    EXPECT_GE(nearest_colours(colours).difference, 10); // CIEDE2000, as of every ramp
}

} // namespace
} // namespace macadam::testing
