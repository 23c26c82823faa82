#include "estimator/live/live_odometer.hpp"
#include "estimator/motion/make_odometer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam::testing {
namespace {

/// Wheel speed ten times a second, up to a time.
TripLog speeds_until(double end_s, double (*speed_mps)(double t_s)) {
    TripLog motion;
    for (int i = 0; i * 0.1 <= end_s + 1e-9; ++i) {
        motion.speed.t_s.push_back(i * 0.1);
        motion.speed.speed_mps.push_back(static_cast<float>(speed_mps(i * 0.1)));
    }
    return motion;
}

double steady(double) {
    return 20;
}

double swinging(double t_s) {
    return 15 + 5 * std::sin(0.3 * t_s);
}

/// Without what is older than a quarter of a minute, as a live trip lets it go.
TripLog lately(TripLog motion) {
    const auto count = std::max<std::ptrdiff_t>(0, std::ssize(motion.speed.t_s) - 150);
    motion.speed.t_s.erase(motion.speed.t_s.begin(), motion.speed.t_s.begin() + count);
    motion.speed.speed_mps.erase(motion.speed.speed_mps.begin(),
                                 motion.speed.speed_mps.begin() + count);
    return motion;
}

} // namespace

TEST(LiveOdometer, OfAWholeTripIsItsOdometer) {
    LiveOdometer ruler;
    for (double now_s = 1; now_s <= 120; now_s += 0.5) {
        ruler = measured_on(std::move(ruler), lately(speeds_until(now_s, swinging)), now_s, {});
    }
    const auto trip = speeds_until(120, swinging);
    const auto whole = make_odometer(trip, {}).odometer;
    // Both are sums of the same trapezoids; the live one begins at its first knot, too.
    EXPECT_NEAR(ruler.odometer->travel_m(120), whole.travel_m(120), 1e-6);
    EXPECT_NEAR(ruler.odometer->travel_m(80.05), whole.travel_m(80.05), 1e-6);
}

TEST(LiveOdometer, NeverChangesWhatIsSettled) {
    LiveOdometer ruler;
    double before_m = 0;
    for (double now_s = 10; now_s <= 60; now_s += 0.5) {
        ruler = measured_on(std::move(ruler), lately(speeds_until(now_s, swinging)), now_s, {});
        const double travel_m = ruler.odometer->travel_m(6);
        if (now_s > 10) {
            EXPECT_DOUBLE_EQ(travel_m, before_m);
        }
        before_m = travel_m;
    }
}

TEST(LiveOdometer, GoesOnAtTheLastSpeed) {
    const auto ruler = measured_on({}, speeds_until(10, steady), 12, {});
    EXPECT_NEAR(ruler.odometer->travel_m(12), 240, 1e-3);
}

TEST(LiveOdometer, DoesNotGoOnForLongWithoutSpeed) {
    const auto ruler = measured_on({}, speeds_until(10, steady), 13, {});
    EXPECT_TRUE(std::isnan(ruler.odometer->speed_mps(13)));
}

TEST(LiveOdometer, EndsWithTheTrip) {
    const auto ruler = measured_on({}, speeds_until(10, steady), 12, {}, true);
    EXPECT_NEAR(ruler.odometer->travel_m(12), 200, 1e-3);
}

TEST(LiveOdometer, KeepsNoMoreThanIsAskedOf) {
    LiveOdometer ruler;
    const LiveRulerConfig config{.odometer = {}, .settled_s = 3, .keep_s = 20};
    for (double now_s = 1; now_s <= 200; now_s += 0.5) {
        ruler = measured_on(std::move(ruler), lately(speeds_until(now_s, steady)), now_s, config);
    }
    EXPECT_LE(ruler.settled.t_s.size(), 200U); // ten a second
}

} // namespace macadam::testing
