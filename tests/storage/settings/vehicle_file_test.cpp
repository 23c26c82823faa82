#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/settings/vehicle_file.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;

namespace {

const std::string half_car = "[half_car]\nms_kg = 1600\nmu_kg = 45\nks_n_per_m = 30000\n"
                             "cs_ns_per_m = 2500\nkt_n_per_m = 2.5e5\nis_kgm2 = 500\nl_m = 0.78\n";
const std::string least = "name = \"rav4-7\"\n" + half_car;

Vehicle read_text(const std::string& text) {
    return read_vehicle(written(test_folder(), "car.toml", text));
}

std::string refusal_of_text(const std::string& text) {
    return refusal_of([&] { read_text(text); });
}

} // namespace

TEST(VehicleFile, NeedsANameAndAHalfCar) {
    const auto car = read_text(least);
    EXPECT_EQ(car.name, "rav4-7");
    EXPECT_EQ(car.gain, 1);
    EXPECT_EQ(gain_for_one_axle(car), 1);
    EXPECT_EQ(car.half_car.ms_kg, 1600);
    EXPECT_EQ(car.half_car.mu_kg, 45);
    EXPECT_EQ(car.half_car.ks_n_per_m, 30000);
    EXPECT_EQ(car.half_car.cs_ns_per_m, 2500);
    EXPECT_EQ(car.half_car.kt_n_per_m, 250000);
    EXPECT_EQ(car.half_car.is_kgm2, 500);
    EXPECT_EQ(car.half_car.l_m, 0.78);
    EXPECT_EQ(car.half_car.antiroll_n_per_m, 0);
    EXPECT_FALSE(car.half_car.friction_n);
    EXPECT_FALSE(car.axles);
    EXPECT_TRUE(car.uncertainty.empty());
}

TEST(VehicleFile, TellsASensorWithoutLowPassFromOneWhoseLowPassIsNotKnown) {
    EXPECT_EQ(read_text(least + "[imu]\nlowpass_hz = 0\n").imu.lowpass_hz, no_lowpass_hz);
    EXPECT_EQ(read_text(least + "[imu]\nx_m = 0\n").imu.lowpass_hz, 0);
}

TEST(VehicleFile, ReadsWhatElseIsKnownOfACar) {
    const auto car = read_text("gain = 0.9\none_axle_gain = 0.72\n" + least +
                               "antiroll_n_per_m = 8000\nfriction_n = 30\n"
                               "[axles]\nwheelbase_m = 2.7\ncg_to_front_m = 1.3\n"
                               "dynamic_index = 0.95\nrear_ratio = 1.1\n"
                               "[imu]\nx_m = -0.5\ny_m = 0.2\nheight_above_roll_axis_m = 0.3\n"
                               "lowpass_hz = 40\nlowpass_order = 4\nnoise_mps2 = 0.1\n"
                               "noise_radps = 0.01\n[uncertainty]\nms_kg = 0.1\ngain = 0.05\n");
    EXPECT_EQ(car.gain, 0.9);
    EXPECT_EQ(gain_for_one_axle(car), 0.72);
    EXPECT_EQ(car.half_car.antiroll_n_per_m, 8000);
    EXPECT_EQ(car.half_car.friction_n, 30);
    ASSERT_TRUE(car.axles);
    EXPECT_EQ(car.axles->wheelbase_m, 2.7);
    EXPECT_EQ(car.axles->cg_to_front_m, 1.3);
    EXPECT_EQ(car.axles->dynamic_index, 0.95);
    EXPECT_EQ(car.axles->rear_ratio, 1.1);
    EXPECT_EQ(car.imu.x_m, -0.5);
    EXPECT_EQ(car.imu.y_m, 0.2);
    EXPECT_EQ(car.imu.height_above_roll_axis_m, 0.3);
    EXPECT_EQ(car.imu.lowpass_hz, 40);
    EXPECT_EQ(car.imu.lowpass_order, 4);
    EXPECT_EQ(car.imu.noise_mps2, 0.1);
    EXPECT_EQ(car.imu.noise_radps, 0.01);
    EXPECT_EQ(car.uncertainty, (std::map<std::string, double>{{"gain", 0.05}, {"ms_kg", 0.1}}));
}

TEST(VehicleFile, RefusesABarThatPushesTheWrongWay) {
    EXPECT_THAT(refusal_of_text(least + "antiroll_n_per_m = -1\n"),
                HasSubstr("car.toml:10: 'half_car.antiroll_n_per_m' is '-1', expected "));
}

TEST(VehicleFile, RefusesKeysThatItDoesNotKnow) {
    EXPECT_THAT(refusal_of_text("colour = \"red\"\n" + least),
                HasSubstr("car.toml:1: unknown key 'colour'"));
    EXPECT_THAT(refusal_of_text(least + "k2_n_per_m = 1\n"),
                HasSubstr("car.toml:10: unknown key 'half_car.k2_n_per_m'"));
    EXPECT_THAT(refusal_of_text(least + "[uncertainty]\nname = 0.1\n"),
                HasSubstr("car.toml:11: unknown key 'uncertainty.name'"));
}

TEST(VehicleFile, RefusesACarOfWhichSomethingIsMissing) {
    EXPECT_THAT(refusal_of_text(half_car), EndsWith("car.toml:1: the key 'name' is missing"));
    EXPECT_THAT(refusal_of_text("name = \"x\"\n"), EndsWith("the key 'half_car' is missing"));
    EXPECT_THAT(refusal_of_text("name = \"x\"\n[half_car]\nms_kg = 1600\n"),
                EndsWith("car.toml:2: the key 'half_car.mu_kg' is missing"));
    EXPECT_THAT(refusal_of_text(least + "[axles]\nwheelbase_m = 2.7\n"),
                EndsWith("car.toml:10: the key 'axles.cg_to_front_m' is missing"));
}

TEST(VehicleFile, RefusesValuesThatNoCarHas) {
    const auto with = [](const std::string& more) { return refusal_of_text(least + more); };
    EXPECT_THAT(refusal_of_text("gain = 0\n" + least),
                EndsWith("car.toml:1: 'gain' is '0', expected a number above 0"));
    EXPECT_THAT(refusal_of_text("gain = nan\n" + least), HasSubstr("expected a number above 0"));
    EXPECT_THAT(refusal_of_text("gain = \"high\"\n" + least),
                EndsWith("'gain' is 'high', expected a number above 0"));
    EXPECT_THAT(
        with("[axles]\nwheelbase_m = 1\ncg_to_front_m = 1.3\n"),
        EndsWith("car.toml:12: 'axles.cg_to_front_m' is '1.3', expected less than wheelbase_m"));
    EXPECT_THAT(with("[imu]\nlowpass_order = 2.5\n"),
                EndsWith("'imu.lowpass_order' is '2.5', expected a whole number from 1 to 8"));
    EXPECT_THAT(with("[imu]\nx_m = 500\n"), HasSubstr("expected metres, from -20 to 20"));
    EXPECT_THAT(with("[uncertainty]\nms_kg = -0.1\n"), HasSubstr("expected a number of 0 or more"));
    EXPECT_THAT(refusal_of_text("name = 7\n" + half_car),
                EndsWith("'name' is '7', expected a text"));
    EXPECT_THAT(refusal_of_text("name = \"x\"\nhalf_car = 3\n"),
                EndsWith("car.toml:2: 'half_car' is '3', expected [half_car]"));
}

TEST(VehicleFile, RefusesWhatIsNoToml) {
    EXPECT_THAT(refusal_of_text("name = \"x\"\n\nms_kg 1600\n"), HasSubstr("car.toml:3: "));
    EXPECT_THAT(refusal_of([] { read_vehicle("/nowhere/car.toml"); }),
                EndsWith("/nowhere/car.toml: cannot be read: No such file or directory"));
}
