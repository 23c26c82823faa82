#include "mapping/privacy/published_event.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace macadam {
namespace {

FusedEvent reported_by(std::int32_t cars) {
    FusedEvent event{.segment = {1, true, 2},
                     .kind = EventKind::pothole,
                     .track = WheelTrack::left,
                     .at_mm = 45'678,
                     .place_sd_mm = 412,
                     .size_um = 31'234,
                     .sd_um = 6'001,
                     .length_mm = 640,
                     .passes = 2 * cars,
                     .passes_over = 3 * cars,
                     .vehicles = cars,
                     .first_seen_ms = 1'770'000'000'000,
                     .last_seen_ms = 1'772'900'000'000};
    event.cars.resize(static_cast<std::size_t>(cars));
    std::iota(event.cars.begin(), event.cars.end(), 1);
    return event;
}

TEST(PublishedEvent, WantsFiveCarsThatReportIt) {
    EXPECT_FALSE(published(reported_by(4), {}));
    EXPECT_TRUE(published(reported_by(5), {}));
}

/// A car under two keys may be one car.
TEST(PublishedEvent, CountsCarsOfALostKeyOnce) {
    auto event = reported_by(8);
    EXPECT_FALSE(published(event, {.last_of_key = {4}}));
    EXPECT_TRUE(published(event, {.last_of_key = {5}}));
    EXPECT_EQ(published(reported_by(15), {.last_of_key = {7}})->vehicles, 5);
}

TEST(PublishedEvent, IsCoarseInPlaceSizeTimeAndCounts) {
    const auto event = published(reported_by(7), {});
    ASSERT_TRUE(event);
    EXPECT_EQ(event->at_mm, 46'000);
    EXPECT_EQ(event->place_sd_mm, 1'000);
    EXPECT_EQ(event->size_um, 30'000);
    EXPECT_EQ(event->sd_um, 10'000);
    EXPECT_EQ(event->length_mm, 500);
    EXPECT_EQ(event->passes, 10);
    EXPECT_EQ(event->passes_over, 20);
    EXPECT_EQ(event->vehicles, 5);
    EXPECT_EQ(event->first_seen_ms, 1'769'904'000'000); // 2026-02-01
    EXPECT_EQ(event->last_seen_ms, 1'772'323'200'000);  // 2026-03-01
    EXPECT_TRUE(event->cars.empty());
}

} // namespace
} // namespace macadam
