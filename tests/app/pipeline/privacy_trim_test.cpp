#include "app/pipeline/privacy_trim.hpp"

#include "app/pipeline/pipeline.hpp"

#include "mapping/network/build_network.hpp"
#include "support/roads/drive.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace macadam {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A drive of 1,200 m to the east along a road that begins 207 m before it, so that its ends lie
/// within segments.
class TrimmedTrip : public ::testing::Test {
protected:
    static constexpr double length_m = 1200;
    static constexpr double before_m = 207;

    static RoadNetwork roads() {
        const testing::Drive along{.length_m = length_m};
        Way way{.id = 7, .name = "", .highway = "primary", .node_ids = {}, .line = {}};
        for (int i = 0; i <= 16; ++i) {
            way.node_ids.push_back(i + 1);
            way.line.push_back(testing::place_of(along, 100.0 * i - before_m));
        }
        return build_network({way});
    }

    static TripResult result(double trim_m, const std::string& trimmed_before_m = "") {
        PipelineConfig config;
        config.trim.min_m = trim_m;
        const auto& car = *built_in_vehicle("golden-car");
        const auto road = testing::patched_road([](double) { return false; }, 1);
        auto trip = testing::drive_over(road, {.length_m = length_m}, car);
        if (!trimmed_before_m.empty()) {
            trip.meta.other["trimmed_m"] = trimmed_before_m;
        }
        return passes_of(std::move(trip), car, roads(), config);
    }

    /// How much of the drive there is on both sides of a pass's segment.
    static double from_end_m(const Pass& pass) {
        const double begin_m = 20.0 * pass.segment.index - before_m;
        return std::min(begin_m, length_m - (begin_m + 20));
    }
};

TEST_F(TrimmedTrip, GivesNoPassWithinTheMetresOfItsEnds) {
    const auto trimmed = result(300);
    ASSERT_THAT(trimmed.passes, Not(IsEmpty()));
    for (const auto& pass : trimmed.passes) {
        EXPECT_GE(from_end_m(pass), 300 - 1) << pass.segment.index; // a match is good to a metre
    }
}

TEST_F(TrimmedTrip, KeepsThePassesBetween) {
    // 600 m hold 29 whole segments, wherever they begin; at most two more reach out.
    EXPECT_GE(result(300).passes.size(), 28U);
    const auto whole = result(0);
    EXPECT_LT(from_end_m(whole.passes.back()), 40);
}

TEST_F(TrimmedTrip, AccountsForEveryRow) {
    const auto rows = result(300).rows;
    EXPECT_EQ(rows.read, rows.used + rows.rejected);
    // 600 of 1,200 m at constant speed, every row of a sensor that is used
    EXPECT_NEAR(static_cast<double>(rows.reasons.at("trimmed")),
                static_cast<double>(rows.read) / 2,
                0.01 * static_cast<double>(rows.read));
}

TEST_F(TrimmedTrip, TellsNeitherTheDepartureNorTheWholeWay) {
    const auto trimmed = result(300);
    // 300 m at 20 m/s; the receiver's latency of 0.2 s lets the trip begin 4 m earlier.
    EXPECT_NEAR(static_cast<double>(trimmed.begin_ms.value()), 14800, 50);
    EXPECT_NEAR(trimmed.distance_m, 604, 2);
    EXPECT_LE(trimmed.matched_m, trimmed.distance_m + 1); // a match is good to a metre
}

TEST_F(TrimmedTrip, LeavesTheTimesOfItsPassesWhereTheyWere) {
    const auto trimmed = result(300);
    const auto whole = result(0);
    const auto& first = trimmed.passes.front();
    const auto same = std::ranges::find(whole.passes, first.segment, &Pass::segment);
    ASSERT_NE(same, whole.passes.end());
    EXPECT_EQ(whole.begin_ms, 0);
    // The match is cut at whole segments, its times to the rounding of a millisecond.
    EXPECT_NEAR(static_cast<double>(first.t_ms + trimmed.begin_ms.value()),
                static_cast<double>(same->t_ms),
                1);
}

TEST_F(TrimmedTrip, TellsNoTimeIfNothingIsLeft) {
    EXPECT_EQ(result(620).begin_ms, std::nullopt);
    EXPECT_EQ(result(620).distance_m, 0);
}

TEST_F(TrimmedTrip, SaysWhatWasLeftOut) {
    EXPECT_THAT(result(300).warnings, Contains("the first and last 300 m were removed"));
}

TEST_F(TrimmedTrip, GivesNothingIfItIsTooShort) {
    const auto trimmed = result(620);
    EXPECT_THAT(trimmed.passes, IsEmpty());
    EXPECT_EQ(trimmed.rows.used, 0U);
    EXPECT_EQ(trimmed.rows.reasons.size(), 1U);
    EXPECT_THAT(trimmed.warnings,
                Contains(HasSubstr("m long, all of it within 620 m of its ends: no pass")));
}

TEST_F(TrimmedTrip, IsNotTrimmedAgainIfTheRecorderLeftOutAsMuch) {
    const auto once = result(300, "300");
    EXPECT_EQ(once.passes.size(), result(0).passes.size());
    EXPECT_FALSE(once.rows.reasons.contains("trimmed"));
    EXPECT_THAT(once.warnings, Not(Contains(HasSubstr("were removed"))));
}

TEST_F(TrimmedTrip, IsTrimmedAsAnyIfTheRecorderLeftOutLess) {
    EXPECT_EQ(result(300, "299").passes.size(), result(300).passes.size());
}

TEST(TrimForATrip, HoldsForTheStopsOfACrowdsCarToo) {
    TripMeta meta;
    meta.other["trimmed_m"] = "300";
    const TrimRule crowd{.min_m = 300, .random_m = 200, .hides_places = true};
    EXPECT_FALSE(trim_for(meta, crowd).is_active());
    EXPECT_TRUE(trim_for(TripMeta{}, crowd).hides_places);
}

} // namespace
} // namespace macadam
