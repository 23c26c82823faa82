#include "mapping/surveys/control_section.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

using ::testing::SizeIs;

SegmentRecord record(std::int64_t way_id, bool forward, double from_m, double to_m) {
    SegmentRecord record{};
    record.segment.key = {way_id, forward, 0};
    record.segment.from_m = from_m;
    record.segment.to_m = to_m;
    return record;
}

TEST(ControlSection, CutsSegmentsToItself) {
    ControlSection section{};
    section.way_id = 7;
    section.forward = true;
    section.from_m = 30;
    section.to_m = 90;
    const auto cut = cut_to(section,
                            {record(7, true, 0, 20),
                             record(7, true, 20, 40),
                             record(7, true, 40, 60),
                             record(7, true, 80, 100),
                             record(7, false, 40, 60),
                             record(8, true, 40, 60)});
    ASSERT_THAT(cut, SizeIs(3));
    EXPECT_EQ(cut[0].segment.from_m, 30);
    EXPECT_EQ(cut[0].segment.to_m, 40);
    EXPECT_EQ(cut[1].segment.to_m - cut[1].segment.from_m, 20);
    EXPECT_EQ(cut[2].segment.to_m, 90);
}

TEST(StudentT, HasTheTablesValues) {
    // Abramowitz and Stegun, table 26.10.
    EXPECT_NEAR(student_t_975(1), 12.706, 0.001);
    EXPECT_NEAR(student_t_975(2), 4.303, 0.004);
    EXPECT_NEAR(student_t_975(3), 3.182, 0.001);
    EXPECT_NEAR(student_t_975(4), 2.776, 0.001);
    EXPECT_NEAR(student_t_975(5), 2.571, 0.003);
    EXPECT_NEAR(student_t_975(6), 2.447, 0.003);
    EXPECT_NEAR(student_t_975(10), 2.228, 0.002);
    EXPECT_NEAR(student_t_975(30), 2.042, 0.002);
    EXPECT_NEAR(student_t_975(1e6), 1.960, 0.001);
}

TEST(StudentT, IsInterpolatedBetweenFewDegreesOfFreedom) {
    EXPECT_NEAR(student_t_975(1.5), (12.706 + 4.303) / 2, 0.001);
    EXPECT_NEAR(student_t_975(5.9), 2.459, 0.003);
    EXPECT_EQ(student_t_975(0.5), student_t_975(1));
}

TEST(Drift, IsTheSlopeOfTheRegressionLine) {
    // 0.1 + 0.3 t, and residuals +d, -d, -d, +d that a line does not see; weights alike.
    const double d = 0.02;
    std::vector<ControlReading> readings;
    for (const int i : {0, 1, 2, 3}) {
        const double sign = i == 0 || i == 3 ? 1 : -1;
        readings.push_back({2020.0 + i, 0.1 + 0.3 * i + sign * d, 0.1});
    }
    const auto drift = drift_of(readings);
    ASSERT_TRUE(drift);
    EXPECT_NEAR(drift->per_year, 0.3, 1e-9);
    // s^2 = 4 d^2 / 2, sum (t - mean)^2 = 5, Student's t for two degrees of freedom.
    EXPECT_NEAR(drift->sd_per_year, std::sqrt(2 * d * d / 5) * 4.3027 / 1.95996, 1e-6);
    EXPECT_TRUE(drift->significant);
}

TEST(Drift, WeighsReadingsByTheirSds) {
    // The last one is worth nothing: the line goes through the others.
    const std::vector<ControlReading> readings{
        {0, 1.0, 0.1}, {1, 1.1, 0.1}, {2, 1.2, 0.1}, {3, 1.3, 0.1}, {4, 9, 1e6}};
    EXPECT_NEAR(drift_of(readings)->per_year, 0.1, 1e-6);
}

TEST(Drift, NeedsFourReadingsOfDifferentTimes) {
    const std::vector<ControlReading> three{{0, 0, 1}, {1, 1, 1}, {2, 2, 1}};
    EXPECT_FALSE(drift_of(three));
    const std::vector<ControlReading> at_once(5, ControlReading{3, 1, 1});
    EXPECT_FALSE(drift_of(at_once));
}

TEST(Drift, OfSteadySectionsIsSeldomSignificant) {
    std::mt19937_64 random{1};
    const auto normal = [&] { // of twelve evens: the same on every machine
        double sum = -6;
        for (int i = 0; i < 12; ++i) {
            sum += static_cast<double>(random() >> 11) * 0x1p-53;
        }
        return sum;
    };
    for (const int months : {4, 6, 12, 24}) {
        constexpr int sections = 2000;
        int significant = 0;
        for (int section = 0; section < sections; ++section) {
            std::vector<ControlReading> readings;
            for (int month = 0; month < months; ++month) {
                readings.push_back({month / 12.0, 0.2 + 0.05 * normal(), 0.15});
            }
            significant += drift_of(readings)->significant ? 1 : 0;
        }
        // 5 % but for 2 in the place of 1.96; its sd over 2000 is 0.5 %.
        EXPECT_NEAR(static_cast<double>(significant) / sections, 0.047, 0.02) << months;
    }
}

} // namespace
} // namespace macadam::testing
