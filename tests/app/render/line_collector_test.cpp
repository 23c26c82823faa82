#include "app/render/line_collector.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <vector>

namespace macadam {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::SizeIs;

const ClassTable& fhwa = *class_table("fhwa"); // good below 1.50, fair below 2.68 mm/m

constexpr double step_deg = 0.0002;

GeoPoint node(std::uint32_t index) {
    return {48, 15 + step_deg * index};
}

/// Adds a segment of way 1 of 20 m. \param iri  negative: without a measurement
void add(LineCollector& lines, std::uint32_t index, bool forward, double iri) {
    const double from_m = 20.0 * index;
    MapLine line;
    line.forward = forward;
    line.line = {node(index + (forward ? 0 : 1)), node(index + (forward ? 1 : 0))};
    if (iri >= 0) {
        line.iri_mm_per_m = iri;
        line.iri_class = static_cast<int>(class_index(fhwa, iri));
    }
    lines.add({{1, forward, index}, from_m, from_m + 20, line.line}, line);
}

/// The lines of both directions of a road, whose roughness is the same.
std::vector<MapLine> joined(const LineJoining& joining, const std::vector<double>& iri) {
    LineCollector lines{joining};
    for (const bool forward : {true, false}) {
        for (std::uint32_t i = 0; i < iri.size(); ++i) {
            add(lines, i, forward, iri[i]);
        }
    }
    return std::move(lines).finished();
}

TEST(LineCollector, KeepsEverySegmentWhereTheScaleShowsThem) {
    const auto lines = joined({}, {1, 1, 1, 1});
    EXPECT_THAT(lines, SizeIs(8));
    EXPECT_THAT(lines, Each(Field(&MapLine::both_ways, true)));
}

TEST(LineCollector, GivesALineTheClassOfItsMean) {
    const auto lines = joined({3, &fhwa}, {1, 1, 4, 5, 5, 5}); // means 2 and 5 mm/m
    ASSERT_THAT(lines, SizeIs(4));
    for (const std::size_t first : {0U, 2U}) {
        EXPECT_NEAR(lines[first].iri_mm_per_m, 2, 1e-12);
        EXPECT_EQ(lines[first].iri_class, 1);
        EXPECT_EQ(lines[first + 1].iri_class, 2);
    }
    EXPECT_THAT(lines, Each(Field(&MapLine::both_ways, true)));
}

TEST(LineCollector, KeepsTheDrivingDirectionOfALine) {
    const auto lines = joined({2, &fhwa}, {1, 1});
    ASSERT_THAT(lines, SizeIs(2));
    EXPECT_EQ(lines[0].line.front().lon_deg, node(0).lon_deg);
    EXPECT_EQ(lines[0].line.back().lon_deg, node(2).lon_deg);
    EXPECT_EQ(lines[1].line.front().lon_deg, node(2).lon_deg);
    EXPECT_EQ(lines[1].line.back().lon_deg, node(0).lon_deg);
}

TEST(LineCollector, JoinsNoRoadWithoutAMeasurementToOneThatHasOne) {
    EXPECT_THAT(joined({3, &fhwa}, {1, -1, -1}), SizeIs(4));
    EXPECT_THAT(joined({3, nullptr}, {1, 1, 4}), SizeIs(4)); // no classes: equal ones alone
}

TEST(LineCollector, JoinsNothingAcrossAGapOfTheWay) {
    LineCollector lines{{3, &fhwa}};
    add(lines, 0, true, 1);
    add(lines, 2, true, 1);
    const auto found = std::move(lines).finished();
    EXPECT_THAT(found, SizeIs(2));
    EXPECT_THAT(found, Each(Field(&MapLine::both_ways, false)));
}

TEST(LineCollector, LeavesOutBendsThatNobodySees) {
    std::vector<GeoPoint> points{node(0), node(1), node(2), node(3)};
    points[1].lat_deg += 0.000051; // 0.1 m beside the straight line to the next
    points[2].lat_deg += 0.0001;
    LineCollector lines{{3, &fhwa, 1}};
    for (std::uint32_t i = 0; i < 3; ++i) {
        MapLine line;
        line.line = {points[i], points[i + 1]};
        lines.add({{1, true, i}, 20.0 * i, 20.0 * i + 20, line.line}, line);
    }
    const auto found = std::move(lines).finished();
    ASSERT_THAT(found, SizeIs(1));
    ASSERT_THAT(found[0].line, SizeIs(3));
    EXPECT_EQ(found[0].line[1].lat_deg, points[2].lat_deg);
}

TEST(LineJoining, StaysBelowHalfTheShortestChangeOfClassOnPaper) {
    const auto segments_at = [](double scale) { return joining_at(scale, 20, fhwa).segments; };
    EXPECT_EQ(segments_at(0), 1U);
    EXPECT_EQ(segments_at(25'000), 1U);  // 0.75 mm are 19 m
    EXPECT_EQ(segments_at(100'000), 3U); // 75 m
    EXPECT_EQ(segments_at(1'000'000), 37U);
    EXPECT_EQ(segments_at(std::numeric_limits<double>::infinity()), 1000U);
}

} // namespace
} // namespace macadam
