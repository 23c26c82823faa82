#include "mapping/analysis/network_summary.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

const ClassTable& fhwa = *class_table("fhwa");
constexpr double exact = 1e-9; // sums of doubles in another order

MeasuredSegment
segment(std::string_view highway, double length_m, IriUm iri_um, std::int32_t passes = 1) {
    static std::uint32_t index = 0;
    MeasuredSegment segment{};
    segment.key = {1, true, ++index};
    segment.to_m = length_m;
    segment.highway = highway;
    segment.iri_um = iri_um;
    segment.sd_um = iri_um / 5;
    segment.passes = passes;
    segment.vehicles = 1;
    return segment;
}

TEST(NetworkSummary, AddsUpLengthAndCoverageByKindOfRoad) {
    const std::vector measured{segment("primary", 100, 1000, 5),
                               segment("primary_link", 50, 2000, 3),
                               segment("residential", 20, 3000, 2)};
    const auto summary = network_summary(
        measured,
        {{"primary", 1000}, {"primary_link", 70}, {"residential", 400}, {"bus_guideway", 30}},
        fhwa);
    EXPECT_EQ(summary.all.network_m, 1500);
    EXPECT_EQ(summary.all.covered_m, 170);
    EXPECT_EQ(summary.all.thrice_m, 150);
    ASSERT_THAT(summary.kinds, SizeIs(3));
    EXPECT_EQ(summary.kinds[0].kind, "primary");
    EXPECT_EQ(summary.kinds[0].network_m, 1070);
    EXPECT_EQ(summary.kinds[0].covered_m, 150);
    EXPECT_EQ(summary.kinds[2].kind, "other");
    EXPECT_EQ(summary.kinds[2].covered_m, 0);
    EXPECT_EQ(summary.kinds[2].p85, 0);
}

TEST(NetworkSummary, WeightsTheMeanByLength) {
    const auto all =
        network_summary(std::vector{segment("", 100, 1000), segment("", 300, 3000)}, {}, fhwa).all;
    EXPECT_NEAR(all.mean.iri, 2.5, exact);
    // sd 0.2 and 0.6, weights 1/4 and 3/4: half of the variance is common.
    const double together = 0.25 * 0.2 + 0.75 * 0.6;
    const double apart = std::hypot(0.25 * 0.2, 0.75 * 0.6);
    EXPECT_NEAR(all.mean.sd, std::sqrt((together * together + apart * apart) / 2), exact);
}

TEST(NetworkSummary, HasThePercentilesOfALongRowOfMetres) {
    std::mt19937 random{3};
    std::vector<MeasuredSegment> measured;
    std::vector<double> metres; // the same road, metre by metre
    for (int i = 0; i < 200; ++i) {
        const int length_m = 1 + static_cast<int>(random() % 40);
        const auto iri_um = static_cast<IriUm>(500 + random() % 6000);
        measured.push_back(segment("service", length_m, iri_um));
        metres.insert(metres.end(), static_cast<std::size_t>(length_m), iri_um / 1000.0);
    }
    std::ranges::sort(metres);
    const auto at = [&](double share) {
        return metres[static_cast<std::size_t>(
                          std::ceil(share * static_cast<double>(metres.size()) - exact)) -
                      1];
    };
    const auto all = network_summary(measured, {}, fhwa).all;
    EXPECT_EQ(all.p50, at(0.50));
    EXPECT_EQ(all.p85, at(0.85));
    EXPECT_EQ(all.p95, at(0.95));
}

TEST(NetworkSummary, PutsEachMetreIntoOneClass) {
    const auto all = network_summary(std::vector{segment("", 10, 1000),
                                                 segment("", 20, 2000),
                                                 segment("", 40, 2600),
                                                 segment("", 80, 9000)},
                                     {},
                                     fhwa)
                         .all;
    std::vector<double> lengths_m;
    std::ranges::transform(
        all.classes, std::back_inserter(lengths_m), [](const auto& c) { return c.length_m; });
    EXPECT_THAT(lengths_m, ElementsAre(10, 60, 80));
}

TEST(NetworkSummary, SaysHowLongAClassWouldBeIfAllReadingsWereOffTogether) {
    // 2.6 mm/m with a common sd of 0.2 * 2.6 * sqrt(1/2) = 0.37: poor from 0.23 sd on, good from
    // -2.99 sd on, which is beyond 90 %.
    const auto all =
        network_summary(std::vector{segment("", 10, 1000), segment("", 40, 2600)}, {}, fhwa).all;
    EXPECT_EQ(all.classes[2].length_m, 0);
    EXPECT_EQ(all.classes[2].low_m, 0);
    EXPECT_EQ(all.classes[2].high_m, 40);
    EXPECT_EQ(all.classes[1].low_m, 0);
    EXPECT_EQ(all.classes[1].high_m, 40);
    EXPECT_EQ(all.classes[0].low_m, 10);
    EXPECT_EQ(all.classes[0].high_m, 10);
}

TEST(NetworkSummary, OfNothingIsZero) {
    const auto summary = network_summary({}, {{"track", 500}}, fhwa);
    EXPECT_EQ(summary.all.network_m, 500);
    EXPECT_EQ(summary.all.mean.iri, 0);
    EXPECT_EQ(summary.all.classes[0].length_m, 0);
}

TEST(IriHistogram, KeepsEveryMetreInItsClassAndPutsTheRestIntoTheLastBin) {
    const std::vector measured{segment("", 10, 0),
                               segment("", 20, 1499),
                               segment("", 25, 1500),
                               segment("", 30, 2600),
                               segment("", 40, 99000)};
    const auto histogram = iri_histogram(measured, fhwa, 0.5, 4);
    EXPECT_THAT(histogram.length_m,
                ElementsAre(ElementsAre(10, 0, 0),
                            ElementsAre(0, 0, 0),
                            ElementsAre(20, 0, 0),
                            ElementsAre(0, 55, 40)));
}

} // namespace
} // namespace macadam
