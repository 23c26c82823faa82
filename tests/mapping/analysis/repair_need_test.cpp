#include "mapping/analysis/worst_sections.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace macadam {
namespace {

using ::testing::ElementsAre;

constexpr double border = 2.68; // of poor, mm/m

WorstSection
section(const std::string& name, const std::string& highway, double length_m, RoadMean mean) {
    WorstSection of{};
    of.name = name;
    of.highway = highway;
    of.length_m = length_m;
    of.mean = mean;
    of.mean.length_m = length_m;
    return of;
}

TEST(RepairNeed, IsLengthTimesExcessTimesTheWeightOfTheRoad) {
    const auto street = section("", "residential", 200, {.iri = 4.68, .low = 3.68, .high = 5.68});
    EXPECT_NEAR(repair_need(street, border).expected, 400, 1e-9); // 200 m times 2 mm/m
    EXPECT_NEAR(repair_need(street, border).certain, 200, 1e-9);
    auto main_road = street;
    main_road.highway = "primary_link";
    EXPECT_NEAR(repair_need(main_road, border).expected, 1600, 1e-9);
    main_road.mean.low = 1;
    EXPECT_EQ(repair_need(main_road, border).certain, 0);
}

TEST(RepairNeed, LetsNoServiceRoadOfOnePassLead) {
    std::vector<WorstSection> sections{
        section("", "service", 150, {.iri = 12, .low = 1, .high = 23}), // one pass
        section("Lane", "residential", 150, {.iri = 5, .low = 4, .high = 6}),
        section("Long lane", "residential", 400, {.iri = 5, .low = 4, .high = 6}),
        section("Avenue", "secondary", 200, {.iri = 5, .low = 4.5, .high = 5.5})};
    sort_by_need(sections, border);
    std::vector<std::string> names;
    for (const auto& each : sections) {
        names.push_back(each.name);
    }
    EXPECT_THAT(names, ElementsAre("Avenue", "Long lane", "Lane", ""));
}

} // namespace
} // namespace macadam
