#include "mapping/events/pass_event.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace macadam {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A pass over segment 2 of way 1, of 20 m, from this travel on.
DrivenPass pass(bool forward, std::uint32_t occurrence, double from_travel_m) {
    const SegmentKey key{1, forward, 2};
    DrivenPass driven;
    driven.pass.segment = key;
    driven.pass.occurrence = occurrence;
    driven.parts.push_back({.segment = key,
                            .segment_m = 20,
                            .from_station_m = forward ? 40.0 : -60.0,
                            .to_station_m = forward ? 60.0 : -40.0,
                            .travel = {from_travel_m, from_travel_m + 20},
                            .t_enter_s = 0,
                            .t_leave_s = 1,
                            .confidence = 1,
                            .place_sd_m = 0.8,
                            .drive = {}});
    return driven;
}

RoadEvent pothole(double travel_m) {
    return {.kind = EventKind::pothole,
            .track = WheelTrack::left,
            .travel_m = travel_m,
            .length_m = 0.75,
            .size_mm = 31.5,
            .sd_mm = 9,
            .score = 12};
}

TEST(PlaceEvents, PutsThemOnTheSegmentByTravel) {
    const std::vector passes{pass(true, 0, 100), pass(true, 1, 500)};
    const std::vector events{pothole(105), pothole(519)};
    const auto placed = place_events(events, passes);
    ASSERT_THAT(placed, SizeIs(2));
    EXPECT_EQ(placed[0],
              (PassEvent{.segment = {1, true, 2},
                         .occurrence = 0,
                         .kind = EventKind::pothole,
                         .track = WheelTrack::left,
                         .at_mm = 45'000,
                         .place_sd_mm = 800,
                         .size_um = 31'500,
                         .sd_um = 9'000,
                         .length_mm = 750}));
    EXPECT_EQ(placed[1].occurrence, 1U);
    EXPECT_EQ(placed[1].at_mm, 59'000);
}

TEST(PlaceEvents, CountAlongTheWayFromItsFirstNodeInBothDirections) {
    const std::vector passes{pass(false, 0, 100)};
    const std::vector events{pothole(105)};
    const auto placed = place_events(events, passes);
    ASSERT_THAT(placed, SizeIs(1));
    EXPECT_EQ(placed[0].at_mm, 55'000);
}

TEST(PlaceEvents, DropWhatLiesOnNoPass) {
    const std::vector passes{pass(true, 0, 100)};
    const std::vector events{pothole(99.9), pothole(120), pothole(300)};
    EXPECT_THAT(place_events(events, passes), IsEmpty());
    EXPECT_THAT(place_events(events, {}), IsEmpty());
    EXPECT_THAT(place_events({}, passes), IsEmpty());
}

TEST(PlaceEvents, DropWhatIsNotFinite) {
    const std::vector passes{pass(true, 0, 100)};
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    auto sizeless = pothole(105);
    sizeless.size_mm = nan;
    auto certain = pothole(105);
    certain.sd_mm = 0;
    const std::vector events{sizeless, certain, pothole(nan)};
    EXPECT_THAT(place_events(events, passes), IsEmpty());
}

} // namespace
} // namespace macadam
