#include "estimator/identification/likelihood/likelihood_fit.hpp"

#include "estimator/common/error.hpp"
#include "estimator/identification/rides.hpp"
#include "estimator/simulation/linear_ride.hpp"
#include "estimator/simulation/random.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam::testing {
namespace {

Vehicle two_axles() {
    auto vehicle = linear_car().vehicle;
    vehicle.imu.x_m = 0.2;
    return vehicle;
}

/// At 15 m/s, with vertical acceleration, pitch and roll rate, all 0.
ProfileDrive empty_drive(const RoadProfile& profile, const Vehicle& vehicle, double duration_s) {
    const auto samples = static_cast<std::size_t>(duration_s * 50);
    Stretch stretch{};
    stretch.step_s = 0.02;
    stretch.vertical_mps2.resize(samples);
    stretch.roll_radps.resize(samples);
    stretch.pitch_radps.resize(samples);
    stretch.speed_mps.assign(samples, 15);
    for (std::size_t k = 0; k < samples; ++k) {
        stretch.travel_m.push_back(5 + 0.3 * static_cast<double>(k));
    }
    return *drive_on_profile(stretch, profile, vehicle, 0);
}

std::vector<double> no_shift(const ProfileDrive& drive) {
    return std::vector<double>(drive.station_m.size());
}

/// The drive with the readings of a car and white noise.
ProfileDrive driven(ProfileDrive drive, const FittedCar& car) {
    drive.felt = simulated_readings(drive, car, 1, no_shift(drive));
    Random random{5};
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        for (double& reading : drive.felt[channel]) {
            reading += (channel < 2 ? 0.05 : 0.002) * random.normal();
        }
    }
    return drive;
}

/// The car has no measure of force: only ratios of masses, springs, dampers and friction count.
TEST(SimulatedReadings, StayTheSameUnderACommonScaleOfMassesAndForces) {
    const auto drive = empty_drive(rough_profile(500, 0, 1), two_axles(), 30);
    auto car = expected_car(two_axles());
    const auto before = simulated_readings(drive, car, 1, no_shift(drive));
    auto& half_car = car.vehicle.half_car;
    for (double* value : {&half_car.ms_kg,
                          &half_car.mu_kg,
                          &half_car.ks_n_per_m,
                          &half_car.cs_ns_per_m,
                          &half_car.kt_n_per_m,
                          &half_car.is_kgm2,
                          &*half_car.friction_n}) {
        *value *= 1.3;
    }
    const auto after = simulated_readings(drive, car, 1, no_shift(drive));
    ASSERT_EQ(before[0].size(), drive.station_m.size());
    for (const std::size_t channel : {0U, 2U, 3U}) {
        for (std::size_t k = 0; k < before[channel].size(); ++k) {
            ASSERT_NEAR(after[channel][k], before[channel][k], 1e-9);
        }
    }
}

/// Against the simulator, which shares no code with the model.
TEST(SimulatedReadings, AreThoseOfTheSimulatedCar) {
    auto recipe = linear_car();
    recipe.antiroll_n_per_m = 0;
    const auto surface = make_surface({.iri_mm_per_m = 3}, 500, 3);
    const auto motion = steady_motion(15, 30);
    const auto stretch = two_axle_ride(recipe, surface, motion, 50); // noise 0.05 m/s2
    const auto drive = *drive_on_profile(stretch, profile_of(surface), recipe.vehicle, 0);
    auto car = expected_car(recipe.vehicle);
    car.vehicle.half_car.friction_n = 0;
    car.rebound_excess = 0;
    car.smoothing_m = 1e-3;
    car.pitch_arm_m = recipe.pitch_arm_m;
    car.roll_arm_m = recipe.cg_above_roll_axis_m;
    const auto modelled = simulated_readings(drive, car, 1, no_shift(drive));
    double square = 0;
    double of_error = 0;
    for (std::size_t k = 200; k < modelled[0].size(); ++k) {
        square += std::pow(drive.felt[0][k], 2);
        of_error += std::pow(drive.felt[0][k] - modelled[0][k], 2);
    }
    const double count = static_cast<double>(modelled[0].size() - 200);
    EXPECT_GT(std::sqrt(square / count), 0.3);
    EXPECT_LT(std::sqrt(of_error / count), 0.055);
}

TEST(LikelihoodFit, FindsACarWithinItsStandardDeviations) {
    auto file = two_axles();
    file.uncertainty["ms_kg"] = 0.1;
    auto truth = expected_car(file);
    truth.vehicle.half_car.ks_n_per_m *= 1.2;
    truth.vehicle.half_car.cs_ns_per_m *= 0.8;
    truth.vehicle.half_car.kt_n_per_m *= 1.1;
    truth.vehicle.axles->dynamic_index = 0.9;
    truth.vehicle.gain = 0.95;
    const auto drive = driven(empty_drive(rough_profile(500, 0, 1), file, 30), truth);
    const auto fit = fit_likelihood(drive, file, {});
    ASSERT_EQ(fit.parameters.size(), 10U);
    EXPECT_TRUE(fit.settled);
    const auto parameters = parameters_of(file, true);
    for (const auto& one : fit.parameters) {
        const auto& parameter = *std::ranges::find(parameters, one.name, &CarParameter::name);
        EXPECT_LT(std::abs(std::log(one.found / parameter.in(truth))), 2.5 * one.sd) << one.name;
    }
    // The scale of masses and forces stays as uncertain as the file leaves it; their ratios do not.
    EXPECT_EQ(fit.parameters[2].name, "ks_n_per_m");
    EXPECT_GT(fit.parameters[2].sd, 0.05);
    EXPECT_LT(fit.parameters[2].sd_given_mass, 0.03);
    EXPECT_GT(fit.correlation(0, 2), 0.9);
    EXPECT_FALSE(fit.vehicle.uncertainty.contains("ms_kg"));
    EXPECT_EQ(fit.vehicle.uncertainty.at("ks_n_per_m"), fit.parameters[2].sd_given_mass);
    EXPECT_THAT(unexcited_parameters(fit), ::testing::Contains("ms_kg"));
    EXPECT_THAT(unexcited_parameters(fit), ::testing::Not(::testing::Contains("ks_n_per_m")));
}

TEST(LikelihoodFit, NamesEveryParameterThatASmoothRoadDoesNotExcite) {
    auto profile = rough_profile(500, 0, 1);
    for (auto* track : {&profile.left_m, &profile.right_m}) {
        std::ranges::for_each(*track, [](double& height) { height *= 0.002; });
    }
    const auto file = two_axles();
    const auto drive = driven(empty_drive(profile, file, 15), expected_car(file));
    const auto fit = fit_likelihood(drive, file, {});
    EXPECT_EQ(unexcited_parameters(fit).size(), fit.parameters.size());
    EXPECT_FALSE(fit.vehicle.half_car.friction_n);
    EXPECT_NEAR(fit.vehicle.half_car.ks_n_per_m, file.half_car.ks_n_per_m, 6000);
}

/// A parameter that the drive determined well is not taken for one that it did not excite, even if
/// an earlier fit has written its prior, which is as small as the model's error.
TEST(LikelihoodFit, ComparesThePriorWithWhatTheDriveTells) {
    LikelihoodFit fit{};
    fit.parameters = {{.name = "ks_n_per_m",
                       .start = 30000,
                       .found = 30100,
                       .prior_sd = 0.016,
                       .sd = 0.0153,
                       .sd_given_mass = 0.0153,
                       .drive_sd = 0.003}};
    EXPECT_TRUE(unexcited_parameters(fit).empty());
    fit.parameters[0].drive_sd = 0.012;
    EXPECT_EQ(unexcited_parameters(fit).size(), 1U);
}

TEST(LikelihoodFit, LeavesOutAFrictionThatNeitherTheFileNorTheDriveTells) {
    auto file = two_axles();
    file.uncertainty["friction_n"] = 0;
    const auto drive = driven(empty_drive(rough_profile(300, 0, 1), file, 15), expected_car(file));
    EXPECT_FALSE(fit_likelihood(drive, file, {}).vehicle.half_car.friction_n);
}

/// A car on springs that do not carry it topples over.
TEST(LikelihoodFit, SaysThatTheModelledReadingsAreNotFinite) {
    auto file = two_axles();
    const auto drive = driven(empty_drive(rough_profile(500, 0, 1), file, 30), expected_car(file));
    file.half_car.ks_n_per_m = 1;
    file.half_car.cs_ns_per_m = 1;
    file.half_car.is_kgm2 = 1;
    file.half_car.friction_n = 0;
    try {
        fit_likelihood(drive, file, {});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("the modelled readings are not finite"));
    }
}

TEST(MovedCar, KeepsTheRatioOfAHeldRollInertiaToTheMass) {
    auto file = two_axles();
    file.half_car.antiroll_n_per_m = 6000;
    file.uncertainty["ms_kg"] = 0.1;
    const auto parameters = parameters_of(file, false); // without roll
    ASSERT_EQ(parameters[0].name, "ms_kg");
    Eigen::VectorXd by = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()));
    by[0] = std::log(1.2);
    const auto half_car = moved(expected_car(file), parameters, by).vehicle.half_car;
    EXPECT_NEAR(half_car.ms_kg, 1.2 * file.half_car.ms_kg, 1e-9);
    EXPECT_NEAR(half_car.is_kgm2, 1.2 * file.half_car.is_kgm2, 1e-9);
    EXPECT_NEAR(half_car.antiroll_n_per_m, 7200, 1e-9);
}

TEST(DriveOnProfile, IsTheMiddleOfALongDrive) {
    const RoadProfile flat{.station_m = {0, 7000}, .left_m = {0, 0}, .right_m = {0, 1}};
    const auto drive = empty_drive(flat, two_axles(), 440); // stations 5 to 6605 m
    EXPECT_NEAR(drive.station_m.front(), 3305 - 2500, 0.5);
    EXPECT_NEAR(drive.station_m.back(), 3305 + 2500, 0.5);
    EXPECT_NEAR(drive.left_out_m, 1600, 0.5);
    EXPECT_EQ(drive.felt[0].size(), drive.station_m.size());
    EXPECT_LT(drive.road.first_m, drive.station_m.front() - 10);
}

TEST(LikelihoodFit, NeedsTenSecondsBeyondItsRunIn) {
    const auto drive = empty_drive(rough_profile(500, 0, 1), two_axles(), 12);
    EXPECT_THROW(fit_likelihood(drive, two_axles(), {}), InputError);
}

} // namespace
} // namespace macadam::testing
