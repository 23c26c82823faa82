#include "estimator/vehicle/vehicle_prior.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

const BodyType& body(std::string_view name) {
    return *std::ranges::find(body_types(), name, &BodyType::name);
}

OwnersData compact() {
    return {.mass_kg = 1430, .wheelbase_m = 2.62, .body = body("compact")};
}

double middle(const ValueRange& range) {
    return (range.min + range.max) / 2;
}

TEST(VehiclesOfOwners, BounceAndHopAsPassengerCarsDo) {
    ASSERT_EQ(body_types().size(), 7U);
    for (const auto& type : body_types()) {
        const auto vehicle = vehicle_of({.mass_kg = middle(type.mass_kg),
                                         .wheelbase_m = middle(type.wheelbase_m),
                                         .body = type},
                                        "mine");
        const auto& car = vehicle.half_car;
        const double quarter_kg = car.ms_kg / 4;
        const double in_series = 1 / (1 / car.ks_n_per_m + 1 / car.kt_n_per_m);
        const double bounce_hz = std::sqrt(in_series / quarter_kg) / (2 * std::numbers::pi);
        const double hop_hz =
            std::sqrt((car.ks_n_per_m + car.kt_n_per_m) / car.mu_kg) / (2 * std::numbers::pi);
        EXPECT_NEAR(bounce_hz, type.bounce_hz, 1e-9) << type.name;
        EXPECT_NEAR(car.cs_ns_per_m / std::sqrt(4 * car.ks_n_per_m * quarter_kg), 0.3, 1e-9);
        EXPECT_GT(hop_hz, 10) << type.name;
        EXPECT_LT(hop_hz, 14) << type.name;
        EXPECT_NEAR(car.ms_kg + 4 * car.mu_kg, middle(type.mass_kg) + 30, 1e-9) << type.name;
    }
}

TEST(VehiclesOfOwners, HaveTheAxlesAndTheUncertaintyOfEveryParameterThatIsGuessed) {
    const auto vehicle = vehicle_of(compact(), "golf");
    EXPECT_EQ(vehicle.name, "golf");
    EXPECT_EQ(vehicle.axles->wheelbase_m, 2.62);
    EXPECT_NEAR(vehicle.axles->cg_to_front_m, 2.62 * 0.4, 1e-9);
    for (const auto* const key : {"gain",
                                  "ms_kg",
                                  "mu_kg",
                                  "ks_n_per_m",
                                  "cs_ns_per_m",
                                  "kt_n_per_m",
                                  "is_kgm2",
                                  "l_m",
                                  "cg_to_front_m",
                                  "dynamic_index",
                                  "rear_ratio"}) {
        ASSERT_TRUE(vehicle.uncertainty.contains(key)) << key;
        EXPECT_GT(vehicle.uncertainty.at(key), 0.01) << key;
        EXPECT_LT(vehicle.uncertainty.at(key), 0.3) << key;
    }
}

TEST(VehiclesOfOwners, AreSurerTheMoreTheOwnerKnows) {
    auto known = compact();
    known.front_share = 0.61;
    known.tyres = parse_tyre_size("205/55R16");
    known.sensor_behind_front_axle_m = 1.2;
    known.mount = SensorMount::fixed;
    const auto more = vehicle_of(known, "golf").uncertainty;
    const auto less = vehicle_of(compact(), "golf").uncertainty;
    for (const auto* const key : {"gain", "kt_n_per_m", "cg_to_front_m"}) {
        EXPECT_LT(more.at(key), less.at(key)) << key;
    }
    EXPECT_EQ(vehicle_of(known, "golf").imu.x_m, 2.62 * 0.39 - 1.2);
}

TEST(BodyTypes, HoldHeavyElectricCarsAndPickupsWithLongCabs) {
    std::size_t count = 0;
    for (const auto& body : body_types()) {
        if (body.name == "suv" || body.name == "pickup") {
            EXPECT_TRUE(body.mass_kg.contains(4250)) << body.name;
            EXPECT_TRUE(body.wheelbase_m.contains(4.5)) << body.name;
            ++count;
        }
    }
    EXPECT_EQ(count, 2U);
}

TEST(TyreSizes, AreReadAsTheyStandOnTyres) {
    for (const auto* const text : {"205/55R16",
                                   "205/55 R16",
                                   "205/55ZR16",
                                   "205/55 R 16",
                                   "205/55r16",
                                   "205/55 R16 91V",
                                   "205/55ZR16 95(W) XL",
                                   "205/55R16C 107/105T",
                                   "P205/55R16",
                                   "LT205/55R16"}) {
        const auto tyre = parse_tyre_size(text);
        ASSERT_TRUE(tyre) << text;
        EXPECT_EQ(tyre->width_mm, 205);
        EXPECT_EQ(tyre->aspect_percent, 55);
        EXPECT_EQ(tyre->rim_in, 16);
    }
    for (const auto* const text : {"",
                                   "205",
                                   "205/55",
                                   "55/205R16",
                                   "205/55R160",
                                   "205/55R16x",
                                   "205/55R16 91V;",
                                   "X205/55R16"}) {
        EXPECT_FALSE(parse_tyre_size(text)) << text;
    }
}

/// Belted radial tyres of cars have 150 to 300 N/mm (J. Y. Wong, "Theory of Ground Vehicles",
/// chapter 1); wider ones more.
TEST(TyreSizes, TellTheStiffness) {
    const auto stiffness_of = [](std::string_view size) {
        auto known = compact();
        known.tyres = parse_tyre_size(size);
        return vehicle_of(known, "golf").half_car.kt_n_per_m;
    };
    EXPECT_GT(stiffness_of("165/70R14"), 150e3);
    EXPECT_LT(stiffness_of("165/70R14"), stiffness_of("205/55R16"));
    EXPECT_LT(stiffness_of("205/55R16"), stiffness_of("255/45R20"));
    EXPECT_LT(stiffness_of("255/45R20"), 320e3);
}

TEST(UsualLowpass, IsAssumedAtTwoFifthsOfTheRateOnlyWhereNoneIsStated) {
    auto vehicle = vehicle_of(compact(), "golf");
    ASSERT_EQ(vehicle.imu.lowpass_hz, 0);
    EXPECT_DOUBLE_EQ(with_usual_lowpass(vehicle, 50).imu.lowpass_hz, 20);
    EXPECT_DOUBLE_EQ(with_usual_lowpass(vehicle, 100).imu.lowpass_hz, 40);
    vehicle.imu.lowpass_hz = 12;
    EXPECT_EQ(with_usual_lowpass(vehicle, 50).imu.lowpass_hz, 12);
    vehicle.imu.lowpass_hz = no_lowpass_hz;
    EXPECT_EQ(with_usual_lowpass(vehicle, 50).imu.lowpass_hz, no_lowpass_hz);
}

} // namespace
} // namespace macadam::testing
