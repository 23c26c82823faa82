// Events in profiles that are given, station by station.

#include "estimator/events/event_detection.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double start_m = 1000;
constexpr double step_m = 0.25;
constexpr std::size_t stations = 800;

/// Numbers in [-0.5, 0.5), the same on every machine.
class Numbers {
public:
    double next() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(state_ >> 11U) / 9007199254740992.0 - 0.5;
    }

private:
    std::uint64_t state_ = 1;
};

/// Random walk whose changes have this standard deviation.
std::vector<float> walk(double change_sd_m, Numbers& numbers) {
    std::vector<float> track_m{0};
    for (std::size_t i = 1; i < stations; ++i) {
        const double change_m = change_sd_m * std::sqrt(12.0) * numbers.next();
        track_m.push_back(
            static_cast<float>(0.99 * static_cast<double>(track_m.back()) + change_m));
    }
    return track_m;
}

std::vector<float> draw(double sd_m, Numbers& numbers) {
    std::vector<float> error_m;
    for (std::size_t i = 0; i < stations; ++i) {
        error_m.push_back(static_cast<float>(sd_m * std::sqrt(12.0) * numbers.next()));
    }
    return error_m;
}

/// Two hundred metres of both tracks, with changes and errors of these standard deviations.
EstimatedProfile road(double change_sd_m = 0.001, double error_sd_m = 0.0003) {
    Numbers numbers;
    EstimatedProfile profile{.start_travel_m = start_m, .step_m = step_m};
    profile.left_m = walk(change_sd_m, numbers);
    profile.right_m = walk(change_sd_m, numbers);
    profile.left_error_m = draw(error_sd_m, numbers);
    profile.right_error_m = draw(error_sd_m, numbers);
    return profile;
}

/// Adds heights from a station on.
void add(std::vector<float>& track_m, std::size_t at, const std::vector<double>& heights_mm) {
    for (std::size_t i = 0; i < heights_mm.size(); ++i) {
        track_m[at + i] += static_cast<float>(heights_mm[i] / 1000);
    }
}

const std::vector<double> hole{-15, -40, -15};
const std::vector<double> ridge{8, 15, 8};

double travel_of(std::size_t station) {
    return start_m + step_m * static_cast<double>(station);
}

} // namespace

TEST(EventDetection, FindsAHoleInItsTrack) {
    auto profile = road();
    add(profile.right_m, 400, hole);
    const auto events = detect_events(profile);
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].kind, EventKind::pothole);
    EXPECT_EQ(events[0].track, WheelTrack::right);
    EXPECT_NEAR(events[0].travel_m, travel_of(401), step_m);
    EXPECT_NEAR(events[0].size_mm, 40, 2 * events[0].sd_mm);
}

TEST(EventDetection, FindsNothingOnAPlainRoad) {
    EXPECT_THAT(detect_events(road()), IsEmpty());
    EXPECT_THAT(detect_events(road(0)), IsEmpty());
    EXPECT_THAT(detect_events({}), IsEmpty());
}

/// The same hole that is clear on a smooth road is one of many changes of a rough one.
TEST(EventDetection, HoldsAHoleBesideTheRoughnessOfTheRoad) {
    auto rough = road(0.008);
    add(rough.right_m, 400, hole);
    EXPECT_THAT(detect_events(rough), IsEmpty());
}

TEST(EventDetection, HoldsAHoleBesideTheErrorOfTheEstimate) {
    auto unsure = road(0.001, 0.01);
    add(unsure.right_m, 400, hole);
    EXPECT_THAT(detect_events(unsure), IsEmpty());
}

TEST(EventDetection, TakesTheSwayingBehindAHoleForItsEcho) {
    auto profile = road();
    add(profile.left_m, 400, hole);
    add(profile.left_m, 410, {-6, -16, -6});
    EXPECT_THAT(detect_events(profile), SizeIs(1));
}

TEST(EventDetection, KeepsASmallerHoleFurtherOn) {
    auto profile = road();
    add(profile.left_m, 400, hole);
    add(profile.left_m, 440, {-6, -16, -6});
    EXPECT_THAT(detect_events(profile), SizeIs(2));
}

TEST(EventDetection, FindsEveryHoleOfALongRoad) {
    constexpr std::size_t parts = 50;
    auto part = road();
    add(part.left_m, 400, hole);
    auto profile = part;
    for (std::size_t i = 1; i < parts; ++i) {
        // Turned round each time, so that the parts meet without a step.
        for (const auto& [from, to] : {std::pair{&part.left_m, &profile.left_m},
                                       std::pair{&part.right_m, &profile.right_m},
                                       std::pair{&part.left_error_m, &profile.left_error_m},
                                       std::pair{&part.right_error_m, &profile.right_error_m}}) {
            std::ranges::reverse(*from);
            to->insert(to->end(), from->begin(), from->end());
        }
    }
    const auto events = detect_events(profile);
    EXPECT_THAT(events, SizeIs(parts));
    EXPECT_TRUE(std::ranges::is_sorted(events, {}, &RoadEvent::travel_m));
}

TEST(EventDetection, FindsNothingWithoutTheErrorOfTheEstimate) {
    auto profile = road();
    add(profile.left_m, 400, hole);
    profile.left_error_m.clear();
    profile.right_error_m.pop_back();
    EXPECT_THAT(detect_events(profile), IsEmpty());
}

TEST(EventDetection, ALineAcrossBothTracksIsAJoint) {
    auto profile = road();
    add(profile.left_m, 400, {-25});
    add(profile.right_m, 400, {-25});
    const auto events = detect_events(profile);
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].kind, EventKind::joint);
    EXPECT_EQ(events[0].track, WheelTrack::both);
}

TEST(EventDetection, AStepIsAJoint) {
    auto profile = road();
    for (auto* track_m : {&profile.left_m, &profile.right_m}) {
        add(*track_m, 400, std::vector<double>(stations - 400, -15));
    }
    const auto events = detect_events(profile);
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].kind, EventKind::joint);
    EXPECT_EQ(events[0].length_m, 0);
    EXPECT_NEAR(events[0].size_mm, 15, 2 * events[0].sd_mm);
}

TEST(EventDetection, TwoLinesAtTheGaugeOfATrackAreRails) {
    auto profile = road();
    for (auto* track_m : {&profile.left_m, &profile.right_m}) {
        add(*track_m, 400, {20});
        add(*track_m, 406, {20});
    }
    const auto events = detect_events(profile);
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].kind, EventKind::rail);
    EXPECT_NEAR(events[0].travel_m, travel_of(403), step_m);
}

TEST(EventDetection, ARaisedPartIsABump) {
    auto profile = road();
    for (auto* track_m : {&profile.left_m, &profile.right_m}) {
        add(*track_m, 400, {5, 20, 40, 55, 60, 55, 40, 20, 5});
    }
    const auto events = detect_events(profile);
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].kind, EventKind::bump);
    EXPECT_EQ(events[0].track, WheelTrack::both);
    EXPECT_NEAR(events[0].travel_m, travel_of(404), step_m);
}

TEST(EventDetection, KnowsNoTrackWhereOnlyTheMeanWasObserved) {
    auto profile = road();
    profile.centre_m = std::move(profile.left_m);
    profile.centre_error_m = std::move(profile.left_error_m);
    profile.left_m.clear();
    profile.right_m.clear();
    add(profile.centre_m, 400, hole);
    const auto events = detect_events(profile);
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].kind, EventKind::pothole);
    EXPECT_EQ(events[0].track, WheelTrack::unknown);
}

TEST(EventDetection, IsInOrderOfTravel) {
    auto profile = road();
    add(profile.right_m, 600, hole);
    add(profile.left_m, 200, hole);
    add(profile.left_m, 500, ridge);
    const auto events = detect_events(profile);
    ASSERT_THAT(events, SizeIs(3));
    EXPECT_LT(events[0].travel_m, events[1].travel_m);
    EXPECT_LT(events[1].travel_m, events[2].travel_m);
}

TEST(EventSeverity, FollowsTheDepthsOfTheDistressManual) {
    EXPECT_EQ(severity_of(24.9), Severity::low);
    EXPECT_EQ(severity_of(25), Severity::moderate);
    EXPECT_EQ(severity_of(50), Severity::moderate);
    EXPECT_EQ(severity_of(50.1), Severity::high);
}

} // namespace macadam::testing
