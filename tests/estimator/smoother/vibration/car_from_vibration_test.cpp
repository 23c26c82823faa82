#include "estimator/smoother/vibration/car_from_vibration.hpp"

#include "estimator/smoother/response_inverse.hpp"
#include "estimator/smoother/smoothed_iri.hpp"
#include "estimator/smoother/worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr Resonance holder{.hz = 15, .damping = 0.08};

/// A minute and more of a world's car: part at one speed, part at another.
struct Drives {
    DrivenRoad slower, faster;
};

Drives drives_in(const World& world, const Resonance& mount, double lowpass_hz = 0) {
    auto recipe = drive_in(world, 60);
    recipe.length_m = 1200;
    recipe.imu.lowpass_hz = lowpass_hz;
    recipe.imu.mount_hz = mount.hz;
    recipe.imu.mount_damping = mount.hz > 0 ? mount.damping : recipe.imu.mount_damping;
    auto faster = recipe;
    faster.speed_kmh = 80;
    return {driven_road(recipe), driven_road(faster)};
}

VibratingCar found_in(const Drives& drives, const Vehicle& vehicle) {
    VibrationSpectra spectra;
    add(spectra, drives.slower.stretch);
    add(spectra, drives.faster.stretch);
    return car_from_vibration(spectra, vehicle);
}

const Vehicle& generic() {
    return *built_in_vehicle("generic");
}

double bias_of(const Drives& drives, const VibratingCar& car) {
    EstimatorConfig config{.method = Method::smoother};
    config.sensors = vertical_and_pitch;
    const auto& [stretch, truth] = drives.slower;
    const auto tuned = car_in(stretch, car, config);
    const auto run = smoothed_iri(stretch, tuned, config);
    return errors_of(held_beside(run, truth, Index::hri, 100, tuned.vehicle)).bias;
}

} // namespace

/// Two minutes tell the wheelbase to some centimetres, whatever the road. A length that is unusual
/// for the class is not believed without more.
TEST(CarFromVibration, FindsTheWheelbaseOfACarOfAClass) {
    for (const auto& world : worlds()) {
        const auto car = found_in(drives_in(world, {}), generic());
        if (world.axles.wheelbase_m > 3) {
            EXPECT_FALSE(car.found_axles) << world.name;
            continue;
        }
        ASSERT_TRUE(car.found_axles) << world.name;
        EXPECT_NEAR(car.vehicle.axles->wheelbase_m, world.axles.wheelbase_m, 0.1) << world.name;
        EXPECT_EQ(car.mount.hz, 0) << world.name;
    }
}

TEST(CarFromVibration, LeavesAKnownCarWithoutAHolderAsItIs) {
    for (const auto& world : worlds()) {
        const auto vehicle = drive_in(world, 60).car.vehicle;
        const auto car = found_in(drives_in(world, {}), vehicle);
        EXPECT_EQ(car.mount.hz, 0) << world.name;
        EXPECT_FALSE(car.found_axles);
        EXPECT_EQ(car.vehicle.axles->wheelbase_m, vehicle.axles->wheelbase_m);
        EXPECT_EQ(car.vehicle.imu.x_m, vehicle.imu.x_m);
        EXPECT_NEAR(car.vehicle.half_car.kt_n_per_m / vehicle.half_car.kt_n_per_m, 1, 0.02);
        EXPECT_EQ(car.vehicle.uncertainty, vehicle.uncertainty);
    }
}

/// The likelihood of a minute takes a linear car for one of 15 % more damping at 20 km/h and of 5 %
/// less at 36 km/h. On the smoothest road at 20 km/h noise hides the wheels.
TEST(CarFromVibration, FindsNoFrictionInALinearCarAtAnySpeed) {
    for (const double speed_kmh : {20.0, 36.0, 80.0}) {
        double sum = 0;
        double count = 0;
        for (const auto& world : worlds()) {
            auto recipe = drive_in(world, speed_kmh);
            recipe.speed_swing = 0.2;
            recipe.length_m = 2400;
            VibrationSpectra spectra;
            add(spectra, driven_road(recipe).stretch);
            const auto damping = car_from_vibration(spectra, recipe.car.vehicle).damping;
            if (!damping) {
                continue;
            }
            EXPECT_NEAR(damping->added, 0, 3 * damping->sd) << world.name << ", " << speed_kmh;
            std::printf("%s, %.0f km/h: damping %+.3f, sd %.3f\n",
                        world.name,
                        speed_kmh,
                        damping->added,
                        damping->sd);
            sum += damping->added;
            ++count;
        }
        ASSERT_GE(count, 5);
        EXPECT_NEAR(sum / count, 0, 0.1) << speed_kmh;
    }
}

/// Friction damps as much as dampers do, the more the less the wheels hop.
TEST(CarFromVibration, FindsTheFrictionOfItsCar) {
    for (const double friction_n : {0.0, 25.0, 60.0}) {
        auto recipe = drive_in(worlds()[5], 60);
        recipe.length_m = 2400;
        recipe.speed_swing = 0.3;
        recipe.car.friction_n = friction_n;
        auto vehicle = recipe.car.vehicle;
        vehicle.half_car.friction_n = std::nullopt;
        EstimatorConfig config{.method = Method::smoother};
        config.sensors = vertical_and_pitch;
        const auto stretch = driven_road(recipe).stretch;
        VibrationSpectra spectra;
        add(spectra, stretch);
        const auto car = car_of_trip(spectra, stretch, vehicle, config).car;
        std::printf(
            "friction %.0f N: %.1f +- %.1f N\n", friction_n, car.friction_n, car.friction_sd_n);
        EXPECT_NEAR(car.friction_n, friction_n, 2 * car.friction_sd_n);
        EXPECT_LT(car.friction_sd_n, 11); // of 15 N before the drive
    }
}

/// What takes high frequencies down is no holder either.
TEST(CarFromVibration, TakesAnUnstatedLowpassForNoHolder) {
    for (const auto& world : worlds()) {
        const auto drives = drives_in(world, {}, 20);
        EXPECT_EQ(found_in(drives, drive_in(world, 60).car.vehicle).mount.hz, 0) << world.name;
        EXPECT_EQ(found_in(drives, generic()).mount.hz, 0) << world.name;
    }
}

TEST(CarFromVibration, FindsAHolderThatResonates) {
    for (const auto& world : worlds()) {
        const auto drives = drives_in(world, holder);
        const auto known = found_in(drives, drive_in(world, 60).car.vehicle);
        EXPECT_NEAR(known.mount.hz, holder.hz, 0.7) << world.name;
        EXPECT_NEAR(known.mount.damping, holder.damping, 0.05) << world.name;
        EXPECT_GT(known.vehicle.uncertainty.at("mount"), 0);
    }
}

/// A resonance at 15 Hz makes an unknown car's road rough; found, it does no more than the car's
/// other unknowns.
TEST(CarFromVibration, TakesAHolderOffTheRoad) {
    const auto& world = worlds()[5];
    const auto plain = drives_in(world, {});
    const auto held = drives_in(world, holder);
    const auto without = found_in(plain, generic());
    const auto with = found_in(held, generic());
    ASSERT_GT(with.mount.hz, 0);
    auto unaware = with;
    unaware.mount = {};
    const double usual = bias_of(plain, without);
    EXPECT_GT(bias_of(held, unaware) - usual, 0.15);
    EXPECT_NEAR(bias_of(held, with), usual, 0.05);
}

TEST(CarFromVibration, TellsNothingFromOneSpeed) {
    auto recipe = drive_in(worlds()[0], 60);
    recipe.speed_swing = 0;
    recipe.imu.mount_hz = holder.hz;
    VibrationSpectra spectra;
    add(spectra, driven_road(recipe).stretch);
    const auto car = car_from_vibration(spectra, generic());
    EXPECT_FALSE(car.found_axles);
    EXPECT_FALSE(car.damping);
    EXPECT_EQ(car.mount.hz, 0);
    EXPECT_EQ(car.vehicle.gain, generic().gain);
}

TEST(CarFromVibration, TellsNothingFromAStillSensorOrAShortDrive) {
    Stretch still{};
    still.step_s = 0.02;
    still.vertical_mps2.assign(3000, 0.0F);
    still.pitch_radps.assign(3000, 0.0F);
    still.speed_mps.assign(3000, 15.0F);
    for (std::size_t k = 0; k < still.speed_mps.size(); ++k) {
        still.speed_mps[k] += 5 * std::sin(0.002F * static_cast<float>(k));
        still.travel_m.push_back(0.3 * static_cast<double>(k));
    }
    VibrationSpectra spectra;
    add(spectra, still);
    EXPECT_FALSE(car_from_vibration(spectra, generic()).found_axles);
    still.vertical_mps2.resize(100);
    VibrationSpectra short_drive;
    add(short_drive, still);
    EXPECT_TRUE(short_drive.speeds.empty());
    EXPECT_FALSE(car_from_vibration(short_drive, generic()).found_axles);
}

TEST(ResponseInverse, GivesBackWavesThatAHolderRaised) {
    const double step_s = 0.02;
    std::vector<double> before(3000);
    std::vector<double> held(before.size());
    for (const double hz : {1.3, 9.1, 14.8, 18.0}) {
        for (std::size_t k = 0; k < before.size(); ++k) {
            const auto wave =
                std::polar(1.0, 2 * std::numbers::pi * hz * step_s * static_cast<double>(k));
            before[k] += wave.imag();
            held[k] += (response(holder, hz) * wave).imag();
        }
    }
    const auto back =
        without_response(held, step_s, [](double hz) { return response(holder, hz); });
    for (std::size_t k = 300; k < 2700; ++k) {
        ASSERT_NEAR(back[k], before[k], 0.05) << k;
    }
}

} // namespace macadam::testing
