#include "estimator/identification/spectrum_fit.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/linear_ride.hpp"
#include "rides.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Vehicle& audi() {
    return *built_in_vehicle("audi-a6-etron");
}

/// What the fit has to find out of nothing: masses and width only.
HalfCar unknown_car(const HalfCar& car) {
    return {.ms_kg = car.ms_kg,
            .mu_kg = car.mu_kg,
            .ks_n_per_m = 1,
            .cs_ns_per_m = 1,
            .kt_n_per_m = 1,
            .is_kgm2 = 1,
            .l_m = car.l_m};
}

/// The car of the paper's table III, by Runge-Kutta over its forces, gain 0.72 and all.
TEST(SpectrumFit, ReturnsTheTrueParametersOfAOneAxleCarWithoutNoise) {
    const auto profile = rough_profile(500, 0, 31);
    const auto ride = simulate_response(one_axle_ride(audi(), profile, 15, 100), profile, 0);
    ASSERT_TRUE(ride);
    const auto fit = fit_spectra(*ride, unknown_car(audi().half_car), 0, {});
    const auto& truth = audi().half_car;
    const double tolerance = 0.01; // straight roads of 2.5 ms in the model
    EXPECT_NEAR(fit.found.ks_n_per_m, truth.ks_n_per_m, tolerance * truth.ks_n_per_m);
    EXPECT_NEAR(fit.found.cs_ns_per_m, truth.cs_ns_per_m, tolerance * truth.cs_ns_per_m);
    EXPECT_NEAR(fit.found.kt_n_per_m, truth.kt_n_per_m, tolerance * truth.kt_n_per_m);
    EXPECT_NEAR(fit.found.is_kgm2, truth.is_kgm2, tolerance * truth.is_kgm2);
    EXPECT_NEAR(fit.gain, 0.72, tolerance * 0.72);
    EXPECT_EQ(fit.found.ms_kg, truth.ms_kg);
    EXPECT_LT(fit.vertical.misfit_after, 0.01);
    EXPECT_GT(fit.vertical.misfit_before, 0.3);
}

TEST(SpectrumFit, ReturnsTheTrueRollInertiaWhereTheHeightIsKnown) {
    Vehicle car = audi();
    car.half_car.is_kgm2 = 800;
    car.imu.height_above_roll_axis_m = 0.4;
    const auto profile = rough_profile(500, 0, 41);
    const auto ride = simulate_response(one_axle_ride(car, profile, 15, 100), profile, 0);
    ASSERT_TRUE(ride);
    const auto fit = fit_spectra(*ride, unknown_car(car.half_car), 0.4, {});
    EXPECT_NEAR(fit.found.is_kgm2, 800, 0.01 * 800);
}

/// Amplitudes know nothing of place: metres of error in the match do no harm to speak of.
TEST(SpectrumFit, BearsThreeMetresOfErrorInThePlace) {
    const auto profile = rough_profile(500, 0, 31);
    const auto stretch = one_axle_ride(audi(), profile, 15, 50);
    const auto right = fit_spectra(*simulate_response(stretch, profile, 0), audi().half_car, 0, {});
    const auto off = fit_spectra(*simulate_response(stretch, profile, 3), audi().half_car, 0, {});
    EXPECT_NEAR(off.found.ks_n_per_m, right.found.ks_n_per_m, 0.03 * right.found.ks_n_per_m);
    EXPECT_NEAR(off.gain, right.gain, 0.03);
}

TEST(SpectrumFit, LeavesTheRollInertiaAsKnownOnOneTrack) {
    auto profile = rough_profile(400, 0, 31);
    profile.right_m = profile.left_m;
    const auto ride = simulate_response(one_axle_ride(audi(), profile, 15, 100), profile, 0);
    const auto fit = fit_spectra(*ride, audi().half_car, 0, {});
    EXPECT_FALSE(fit.lateral);
    EXPECT_EQ(fit.found.is_kgm2, audi().half_car.is_kgm2);
    EXPECT_FALSE(fit.relative_sd.contains("is_kgm2"));
}

TEST(SpectrumFit, RefusesARideOfAFewSeconds) {
    const auto profile = rough_profile(150, 0, 31);
    const auto ride = simulate_response(one_axle_ride(audi(), profile, 15, 100), profile, 0);
    EXPECT_THAT([&] { fit_spectra(*ride, audi().half_car, 0, {}); },
                ThrowsMessage<InputError>(HasSubstr("drives 9.9 s continuously on the profile "
                                                    "(from 0 to 149 m), expected at least 13")));
}

TEST(SpectrumFit, RefusesARideWithoutVerticalAcceleration) {
    const auto profile = rough_profile(400, 0, 31);
    auto stretch = one_axle_ride(audi(), profile, 15, 100);
    stretch.vertical_mps2.clear();
    EXPECT_THAT(
        [&] { fit_spectra(*simulate_response(stretch, profile, 0), audi().half_car, 0, {}); },
        ThrowsMessage<InputError>(HasSubstr("has no vertical acceleration")));
}

SpectrumFit fit_of_gain(double gain) {
    return {.start = {},
            .found = audi().half_car,
            .gain = gain,
            .vertical = {},
            .lateral = {},
            .relative_sd = {{"gain", 0.05}}};
}

TEST(IdentifiedVehicle, TakesTheGainOfOneAxleForThatWhereItHasTwo) {
    Vehicle car = audi();
    car.gain = 1;
    car.axles = Axles{.wheelbase_m = 2.9, .cg_to_front_m = 1.4};
    const auto found = identified(car, fit_of_gain(0.73));
    EXPECT_EQ(found.gain, 1);
    EXPECT_EQ(found.one_axle_gain, 0.73);
    EXPECT_EQ(gain_for_one_axle(found), 0.73);
}

TEST(IdentifiedVehicle, TakesTheGainForItsOwnWhereNoAxlesAreStated) {
    const auto found = identified(audi(), fit_of_gain(0.8));
    EXPECT_EQ(found.gain, 0.8);
    EXPECT_FALSE(found.one_axle_gain);
    EXPECT_EQ(found.uncertainty.at("gain"), 0.05);
}

} // namespace
} // namespace macadam::testing
