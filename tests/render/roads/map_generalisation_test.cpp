#include "render/roads/map_generalisation.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;

constexpr double step_m = 20;

/// A road to the north in pieces of 20 m with those IRI, by the classes of fhwa.
std::vector<MapLine> road(const std::vector<double>& iri_mm_per_m) {
    const auto at = [](std::size_t i) { return GeoPoint{48 + double(i) * step_m / 111'195, 16}; };
    std::vector<MapLine> lines;
    for (std::size_t i = 0; i < iri_mm_per_m.size(); ++i) {
        MapLine line;
        line.line = {at(i), at(i + 1)};
        line.iri_mm_per_m = iri_mm_per_m[i];
        line.iri_class = int(class_index(*class_table("fhwa"), iri_mm_per_m[i]));
        lines.push_back(line);
    }
    return lines;
}

std::vector<int> classes_at(std::vector<MapLine> lines, double min_run_m) {
    join_short_classes(lines, all_lines(lines), *class_table("fhwa"), min_run_m);
    std::vector<int> classes;
    for (const auto& line : lines) {
        classes.push_back(line.iri_class);
    }
    return classes;
}

TEST(MapGeneralisation, JoinsARunThatIsTooShortOnPaperByTheMeanIri) {
    const auto lines = road({1, 1, 1, 2, 1, 1, 3, 3, 3});
    EXPECT_THAT(classes_at(lines, 30), ElementsAre(0, 0, 0, 0, 0, 0, 2, 2, 2));
    // All is fair where only its mean can be shown.
    EXPECT_THAT(classes_at(lines, 500), ElementsAre(1, 1, 1, 1, 1, 1, 1, 1, 1));
}

TEST(MapGeneralisation, KeepsRunsThatAreLongEnough) {
    EXPECT_THAT(classes_at(road({1, 3, 1, 2}), 15), ElementsAre(0, 2, 0, 1));
}

TEST(MapGeneralisation, TakesTheLongerRunWhereThereIsNoIri) {
    auto lines = road({1, 1, 3, 1});
    for (auto& line : lines) {
        line.iri_mm_per_m = std::numeric_limits<double>::quiet_NaN();
    }
    EXPECT_THAT(classes_at(lines, 30), ElementsAre(0, 0, 0, 0));
}

TEST(MapGeneralisation, ShowsMinorRoadsWithoutAMeasurementAtLargeScalesAlone) {
    MapLine service;
    service.rank = 5;
    EXPECT_TRUE(is_shown(service, 50'000));
    EXPECT_FALSE(is_shown(service, 51'000));
    service.iri_class = 0;
    EXPECT_TRUE(is_shown(service, 1e6));
}

TEST(MapGeneralisation, NamesMainRoadsDownToSmallerScales) {
    EXPECT_TRUE(is_named(1, 250'000));
    EXPECT_FALSE(is_named(4, 250'000));
    EXPECT_TRUE(is_named(4, 25'000));
}

} // namespace
} // namespace macadam::testing
