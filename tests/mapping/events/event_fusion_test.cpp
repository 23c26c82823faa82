#include "mapping/events/event_fusion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace macadam {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t day_ms = 86'400'000;
constexpr std::int64_t some_day = 20'000; // since 1970

EventReport
report(std::int64_t trip, double station_m, EventKind kind = EventKind::pothole, int day = 0) {
    return {.event = {.segment = {1, true, static_cast<std::uint32_t>(station_m / 20)},
                      .occurrence = 0,
                      .kind = kind,
                      .track = WheelTrack::unknown,
                      .at_mm = static_cast<std::int64_t>(1000 * station_m),
                      .place_sd_mm = 1000,
                      .size_um = 30'000,
                      .sd_um = 9'500,
                      .length_mm = 750},
            .station_m = station_m,
            .trip = trip,
            .vehicle = trip % 3,
            .utc_ms = (some_day + day) * day_ms + 3'600'000};
}

EventReport in_track(EventReport report, WheelTrack track) {
    report.event.track = track;
    return report;
}

/// Five segments of 20 m that so many trips passed, one a day.
std::vector<SearchedSegment> road(int passes) {
    std::vector<SearchedSegment> segments;
    for (std::uint32_t i = 0; i < 5; ++i) {
        segments.push_back({{1, true, i}, 20.0 * i, 20.0 * (i + 1), {}});
        for (int day = 0; day < passes; ++day) {
            segments.back().passes_utc_ms.emplace_back((some_day + day) * day_ms + 3'600'000);
        }
    }
    return segments;
}

TEST(FuseEvents, JoinsWhatPassesReportWithinTwoMetres) {
    const auto events = fuse_events({report(1, 49.2), report(2, 50), report(3, 50.8)}, road(3));
    ASSERT_THAT(events, SizeIs(1));
    const auto& event = events[0];
    EXPECT_EQ(event.segment, (SegmentKey{1, true, 2}));
    EXPECT_EQ(event.kind, EventKind::pothole);
    EXPECT_EQ(event.at_mm, 50'000);
    EXPECT_EQ(event.place_sd_mm, 577); // 1 m / sqrt(3)
    EXPECT_EQ(event.size_um, 30'000);
    EXPECT_EQ(event.length_mm, 750);
    EXPECT_EQ(event.passes, 3);
    EXPECT_EQ(event.passes_over, 3);
    EXPECT_EQ(event.vehicles, 3);
}

TEST(FuseEvents, WantsTwoPassesAndAThirdOfThoseOverThePlace) {
    EXPECT_THAT(fuse_events({report(1, 50)}, road(1)), IsEmpty());
    EXPECT_THAT(fuse_events({report(1, 50), report(2, 50)}, road(6)), SizeIs(1));
    EXPECT_THAT(fuse_events({report(1, 50), report(2, 50)}, road(7)), IsEmpty());
}

/// A new hole must not wait until it outweighs the years without it.
TEST(FuseEvents, CountPassesFromTheDayOfTheFirstReportOn) {
    const auto events = fuse_events(
        {report(1, 50, EventKind::pothole, 18), report(2, 50, EventKind::pothole, 19)}, road(20));
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].passes_over, 2);
    EXPECT_EQ(events[0].first_seen_ms, (some_day + 18) * day_ms + 3'600'000);
    EXPECT_EQ(events[0].last_seen_ms, (some_day + 19) * day_ms + 3'600'000);
}

TEST(FuseEvents, CountAllPassesWhereTheReportsHaveNoDate) {
    auto reports = std::vector{report(1, 50), report(2, 50)};
    reports[0].utc_ms = reports[1].utc_ms = std::nullopt;
    EXPECT_THAT(fuse_events(reports, road(7)), IsEmpty());
    const auto events = fuse_events(reports, road(6));
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].first_seen_ms, std::nullopt);
}

TEST(FuseEvents, KeepKindsAndPlacesApart) {
    const auto events = fuse_events({report(1, 50),
                                     report(2, 50.5),
                                     report(1, 53),
                                     report(2, 53.4),
                                     report(1, 50.2, EventKind::joint),
                                     report(2, 50.2, EventKind::joint),
                                     report(3, 50.2, EventKind::bump)},
                                    road(3));
    ASSERT_THAT(events, SizeIs(3));
    EXPECT_EQ(events[0].kind, EventKind::joint);
    EXPECT_EQ(events[1].at_mm, 50'250);
    EXPECT_EQ(events[2].at_mm, 53'200);
}

TEST(FuseEvents, NeverTakeTwoReportsOfOnePass) {
    EXPECT_THAT(fuse_events({report(1, 50), report(1, 51.2)}, road(2)), IsEmpty());
    auto again = report(1, 51.2);
    again.event.occurrence = 1; // it came back
    EXPECT_THAT(fuse_events({report(1, 50), again}, road(2)), SizeIs(1));
}

TEST(FuseEvents, NeverJoinTheLeftWithTheRightTrack) {
    const auto left = WheelTrack::left, right = WheelTrack::right;
    EXPECT_THAT(
        fuse_events({in_track(report(1, 50), left), in_track(report(2, 50), right)}, road(2)),
        IsEmpty());
    const auto events = fuse_events({in_track(report(1, 50), left),
                                     report(2, 50),
                                     in_track(report(3, 50), left),
                                     in_track(report(4, 50), right),
                                     in_track(report(5, 50), right)},
                                    road(5));
    ASSERT_THAT(events, SizeIs(2));
    EXPECT_EQ(events[0].track, left);
    EXPECT_EQ(events[0].passes, 3);
    EXPECT_EQ(events[1].track, right);
}

TEST(FuseEvents, WeighSizesByTheirVariance) {
    auto sharp = report(1, 50);
    sharp.event.size_um = 40'000;
    sharp.event.sd_um = 1'000;
    auto vague = report(2, 50);
    vague.event.size_um = 20'000;
    vague.event.sd_um = 20'000;
    const auto events = fuse_events({sharp, vague}, road(2));
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_GT(events[0].size_um, 39'900);
    EXPECT_GT(events[0].sd_um, 0);
}

TEST(FuseEvents, SayTheSameInAnyOrder) {
    std::mt19937 random{7};
    std::uniform_real_distribution<double> place{5, 95};
    std::vector<EventReport> reports;
    for (int trip = 0; trip < 200; ++trip) {
        reports.push_back(report(trip % 20, place(random), EventKind{}, trip % 20));
        reports.back().event.kind = static_cast<EventKind>(trip % 4);
        reports.back().event.track = static_cast<WheelTrack>(trip % 3);
    }
    const auto events = fuse_events(reports, road(20));
    EXPECT_FALSE(events.empty());
    for (int round = 0; round < 5; ++round) {
        std::ranges::shuffle(reports, random);
        EXPECT_EQ(fuse_events(reports, road(20)), events);
    }
}

TEST(FuseEvents, LieOnTheirWayInBothDirections) {
    std::vector<SearchedSegment> segments{{{1, false, 1}, -40, -20, {}},
                                          {{1, false, 0}, -20, 0, {}}};
    const auto events = fuse_events({report(1, -12), report(2, -12.5)}, segments);
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].segment, (SegmentKey{1, false, 0}));
    EXPECT_EQ(events[0].at_mm, 12'250);
}

TEST(FuseEvents, OfNothingAreNone) {
    EXPECT_THAT(fuse_events({}, road(3)), IsEmpty());
    EXPECT_THAT(fuse_events({report(1, 50), report(2, 50)}, {}), IsEmpty());
}

} // namespace
} // namespace macadam
