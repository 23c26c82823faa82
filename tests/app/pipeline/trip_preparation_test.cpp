#include "app/pipeline/trip_preparation.hpp"

#include "estimator/vehicle/vehicle.hpp"
#include "support/roads/drive.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace macadam {
namespace {

using testing::Drive;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TripLog even_drive() {
    return testing::drive_over(
        [](double /*x_m*/) { return 0; }, Drive{}, *built_in_vehicle("golden-car"));
}

TripLog unstated(TripLog trip) {
    trip.meta.gnss_latency_stated = false;
    trip.meta.gnss_latency_s = 0;
    return trip;
}

/// A car that speeds up and slows down by 5 m/s in 20 s; GNSS says so half a second late.
TripLog late_drive() {
    auto trip = even_drive();
    const auto wave_mps = [](double t_s) { return 5 * std::sin(2 * M_PI * t_s / 20); };
    for (std::size_t i = 0; i < trip.speed.t_s.size(); ++i) {
        trip.speed.speed_mps[i] += static_cast<float>(wave_mps(trip.speed.t_s[i]));
    }
    for (auto& fix : trip.fixes) {
        fix.speed_mps = static_cast<float>(20 + wave_mps(fix.t_s - 0.5));
    }
    return unstated(std::move(trip));
}

TEST(TripPreparation, LeavesAStatedLatencyAsItIs) {
    const auto trip = even_drive();
    ASSERT_TRUE(trip.meta.gnss_latency_stated);
    const auto found = prepared(trip);
    EXPECT_EQ(found.trip.meta.gnss_latency_s, trip.meta.gnss_latency_s);
    EXPECT_THAT(found.warnings, IsEmpty());
    EXPECT_EQ(found.motion.odometer.whole_m(), motion_of(trip).odometer.whole_m());
}

TEST(TripPreparation, FindsTheMotionForTheLatencyThatItEstimates) {
    const auto found = prepared(late_drive());
    // The step of the lags, of which a parabola finds fractions.
    EXPECT_NEAR(found.trip.meta.gnss_latency_s, 0.5, 0.05);
    EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("GNSS delay estimated at 0.5")));
    EXPECT_EQ(found.motion.odometer.scale(), motion_of(found.trip).odometer.scale());
}

TEST(TripPreparation, SaysThatALatencyCannotBeKnownFromPositionsAlone) {
    auto trip = unstated(even_drive());
    trip.speed = {};
    trip.gyro = {};
    const auto found = prepared(std::move(trip));
    EXPECT_EQ(found.trip.meta.gnss_latency_s, 0);
    EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("GNSS delay unknown")));
    EXPECT_EQ(found.motion.odometer.whole_m(), motion_of(found.trip).odometer.whole_m());
}

TEST(TripPreparation, HasNothingToSayOfATripWithoutPositions) {
    auto trip = unstated(even_drive());
    trip.fixes.clear();
    EXPECT_THAT(prepared(std::move(trip)).warnings, IsEmpty());
}

} // namespace
} // namespace macadam
