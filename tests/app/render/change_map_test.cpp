#include "app/render/change_map.hpp"

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
constexpr std::int64_t border_ms = 1'767'225'600'000; // 2026-01-01

/// Ten trips before 2026 and ten since. The first three segments forward become rougher, the last
/// three smoother; one segment is driven before alone.
std::string changed_roads(const std::filesystem::path& folder) {
    const auto file = (folder / "roads.gpkg").string();
    auto store = new_store(file);
    for (int number = 0; number < 20; ++number) {
        const bool is_since = number >= 10;
        auto trip = trip_record(number);
        trip.t0_utc_ms = border_ms + (number - 10) * day_ms + day_ms / 2;
        auto passes = passes_of(number);
        std::erase_if(passes, [&](const Pass& pass) {
            return !pass.segment.forward || (is_since && pass.segment.index == 5);
        });
        for (auto& pass : passes) {
            const int change = pass.segment.index < 3 ? 1 : pass.segment.index >= 7 ? -1 : 0;
            pass.iri_um = 3000 + (is_since ? change * 1500 : 0);
            pass.iri_left_um = pass.iri_right_um = pass.iri_um;
            pass.sd_um = 200;
        }
        add_trip(store, trip, passes);
    }
    store.importer.refresh();
    return file;
}

MapRequest request() {
    MapRequest request{.title = "Change", .size = {.width_px = 800, .height_px = 600}};
    request.style.ramp = "viridis"; // not diverging: replaced
    return request;
}

/// Lines by verdict: smoother, not significant, rougher, not comparable, not measured.
std::array<int, 5> counts_of(const MapScene& scene) {
    std::array<int, 5> counts{};
    for (const auto& line : scene.lines) {
        ++counts.at(line.iri_class < 0 ? 4
                    : line.few_passes  ? 3
                                       : static_cast<std::size_t>(line.iri_class));
    }
    return counts;
}

TEST(ChangeMap, ColoursSegmentsByTheVerdictOnTheirChange) {
    const auto store = StoreReader::open(changed_roads(test_folder()));
    const auto plan = load_change_map(store, request(), border_ms);
    const auto counts = counts_of(plan.scene());
    EXPECT_EQ(counts[0], 3);
    EXPECT_EQ(counts[1], 3);
    EXPECT_EQ(counts[2], 3);
    EXPECT_EQ(counts[3], 1); // driven before alone
    EXPECT_GT(counts[4], 10);
    EXPECT_THAT(plan.scene().subtitle, HasSubstr("before 2026-01-01 against since"));
}

TEST(ChangeMap, CountsPassesOfBothSidesForTheLeastNumber) {
    const auto store = StoreReader::open(changed_roads(test_folder()));
    auto at_least = request();
    at_least.filter.min_passes = 11; // more than either side has; the segment driven before has 10
    const auto counts = counts_of(load_change_map(store, at_least, border_ms).scene());
    EXPECT_EQ(counts[0], 3);
    EXPECT_EQ(counts[2], 3);
    EXPECT_EQ(counts[3], 0);
}

TEST(ChangeMap, ExplainsItsColoursInTheLegend) {
    const auto store = StoreReader::open(changed_roads(test_folder()));
    const auto plan = load_change_map(store, request(), border_ms);
    const auto legend = legend_of(plan.scene(), plan.style(), *plan.style().classes);
    EXPECT_EQ(legend.title, "Change of roughness since 2026-01-01");
    std::vector<std::string> names;
    for (const auto& entry : legend.entries) {
        names.push_back(entry.name);
        EXPECT_EQ(entry.range, "");
    }
    EXPECT_THAT(
        names,
        ElementsAre(
            "Smoother", "Not significant", "Rougher", "Not comparable", "No dated measurement"));
    EXPECT_EQ(legend.entries[0].length, "0.1 km");           // 3 segments of 20 m
    EXPECT_EQ(class_colours(plan.style(), 3)[1], 0xf7f7f7U); // neutral: not significant
}

TEST(ChangeMap, TellsNotComparableFromNotSignificantOnEveryGround) {
    const auto store = StoreReader::open(changed_roads(test_folder()));
    using Theme = MapStyle::Theme;
    for (const auto theme : {Theme::light, Theme::dark, Theme::print}) {
        auto themed = request();
        themed.style.theme = theme;
        const auto style = load_change_map(store, themed, border_ms).style();
        constexpr double clear = 10; // distinguished at a glance
        for (const auto sight : all_sights) {
            EXPECT_GT(
                colour_difference(class_colours(style, 3)[1], palette(style).few_passes, sight),
                clear);
        }
    }
}

TEST(ChangeMap, ComparesWithinABoxWhatIsOnThePicture) {
    const auto store = StoreReader::open(changed_roads(test_folder()));
    auto boxed = request();
    boxed.filter.box = grown(store.info().box, 100);
    EXPECT_EQ(counts_of(load_change_map(store, boxed, border_ms).scene())[2], 3);
}

TEST(ChangeMap, ComparesOnlyPassesOfTheSelectedTime) {
    const auto store = StoreReader::open(changed_roads(test_folder()));
    auto early = request();
    early.filter.period = Period{std::nullopt, border_ms}; // nothing since
    const auto counts = counts_of(load_change_map(store, early, border_ms).scene());
    EXPECT_EQ(counts[0] + counts[1] + counts[2], 0);
    EXPECT_EQ(counts[3], 10);
}

TEST(ChangeMap, RefusesASelectionWithoutDatedPasses) {
    const auto store = StoreReader::open(changed_roads(test_folder()));
    auto none = request();
    none.filter.name_part = "nowhere";
    EXPECT_THAT(refusal_of([&] { load_change_map(store, none, border_ms); }),
                HasSubstr("the selection contains no dated measurement"));
}

} // namespace
} // namespace macadam::testing
