#include "storage/settings/sample_scenario.hpp"
#include "storage/settings/scenario_file.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <algorithm>

using namespace macadam;
using namespace macadam::testing;
using ::testing::HasSubstr;

namespace {

FleetScenario read_text(const std::string& text) {
    return read_recipe(written(test_folder(), "mine.toml", text));
}

std::string refusal_of_text(const std::string& text) {
    return refusal_of([&] { read_text(text); });
}

} // namespace

TEST(Recipe, OfNothingIsTheSample) {
    const auto recipe = read_text("");
    EXPECT_EQ(recipe.cars.size(), 5U);
    EXPECT_EQ(recipe.roads.size(), 5U);
    EXPECT_EQ(recipe.driving.trips, 20U);
    EXPECT_EQ(recipe.driving.to_utc_s - recipe.driving.from_utc_s, 364 * 86400);
    EXPECT_EQ(recipe.knowledge.ms_kg, 0.05);
    EXPECT_EQ(recipe.knowledge.gain, 0);
}

TEST(Recipe, OfTheSampleIsTheSample) {
    const auto shown = read_text(std::string{sample_recipe()});
    const auto own = read_text("");
    EXPECT_EQ(shown.cars.size(), own.cars.size());
    EXPECT_EQ(shown.driving.speed_kmh, own.driving.speed_kmh);
    EXPECT_EQ(shown.gnss.latency_s, own.gnss.latency_s);
}

TEST(Recipe, ChangesOnlyWhatItSays) {
    const auto recipe = read_text("[trips]\ncount = 3\n[gnss]\nlatency_s = [0.2, 0.2]\n"
                                  "[imu]\nnoise_mps2 = 0.1\n");
    EXPECT_EQ(recipe.driving.trips, 3U);
    EXPECT_EQ(recipe.driving.places, 24U);
    EXPECT_EQ(recipe.gnss.latency_s, (Bounds{0.2, 0.2}));
    EXPECT_EQ(recipe.gnss.rate_hz, 5);
    EXPECT_EQ(recipe.cars.size(), 5U);
    EXPECT_TRUE(std::ranges::all_of(
        recipe.cars, [](const FleetCarRecipe& car) { return car.imu.noise_mps2 == 0.1; }));
}

TEST(Recipe, MakesACarLikeAnother) {
    const auto recipe = read_text("[[car]]\nid = \"mine\"\nlike = \"suv\"\nms_kg = 2000\n"
                                  "wheelbase_m = 2.9\nimu_rate_hz = 50\nsensors = [\"acc\"]\n"
                                  "cg_above_roll_axis_m = 0.6\npitch_arm_m = 0.2\n");
    ASSERT_EQ(recipe.cars.size(), 1U);
    const auto& car = recipe.cars.front();
    EXPECT_EQ(car.car.vehicle.name, "mine");
    EXPECT_EQ(car.car.vehicle.half_car.ms_kg, 2000);
    EXPECT_EQ(car.car.vehicle.half_car.mu_kg, built_in_vehicle("suv")->half_car.mu_kg);
    EXPECT_EQ(car.car.vehicle.axles->wheelbase_m, 2.9);
    EXPECT_EQ(car.car.cg_above_roll_axis_m, 0.6);
    EXPECT_EQ(car.car.pitch_arm_m, 0.2);
    EXPECT_EQ(car.imu.rate_hz, 50);
    EXPECT_TRUE(car.acc);
    EXPECT_FALSE(car.gyro);
    EXPECT_FALSE(car.wheel_speed);
}

TEST(Recipe, RuleSaysNothingOfWhatItLeavesOut) {
    const auto recipe = read_text("[[road]]\nhighway = \"motorway\"\niri_mm_per_m = [1, 2]\n"
                                  "[[road]]\nway_id = 12\nname = \"A 9\"\nshare = 0.5\n");
    ASSERT_EQ(recipe.roads.size(), 2U);
    EXPECT_EQ(recipe.roads[0].highways, std::vector<std::string>{"motorway"});
    EXPECT_EQ(recipe.roads[0].iri_mm_per_m, (Bounds{1, 2}));
    EXPECT_FALSE(recipe.roads[0].waviness);
    EXPECT_EQ(recipe.roads[1].way_id, 12);
    EXPECT_EQ(recipe.roads[1].name, "A 9");
    EXPECT_FALSE(recipe.roads[1].iri_mm_per_m);
}

TEST(Recipe, BendsTheSpectrumOfARule) {
    const auto recipe = read_text("[[road]]\nlong_wave_ratio = [0.4, 7.8]\n[[road]]\n"
                                  "short_wave_ratio = [0.3, 0.3]\n");
    ASSERT_EQ(recipe.roads.size(), 2U);
    EXPECT_EQ(recipe.roads[0].long_wave_ratio, (Bounds{0.4, 7.8}));
    EXPECT_FALSE(recipe.roads[0].short_wave_ratio);
    EXPECT_EQ(recipe.roads[1].short_wave_ratio, (Bounds{0.3, 0.3}));
    EXPECT_THAT(refusal_of_text("[[road]]\nlong_wave_ratio = [0, 2]\n"),
                HasSubstr("mine.toml:2: 'road.long_wave_ratio' is an array, expected two numbers, "
                          "the first not above the second, each a number from 0.2 to 8"));
}

TEST(Recipe, StatesHowWrongVehicleFilesAre) {
    const auto knowledge =
        read_text("[knowledge]\nrelative_sd = 0.1\ncs_ns_per_m = 0.2\ngain = 0.03\n").knowledge;
    EXPECT_EQ(knowledge.ms_kg, 0.1);
    EXPECT_EQ(knowledge.is_kgm2, 0.1);
    EXPECT_EQ(knowledge.cs_ns_per_m, 0.2);
    EXPECT_EQ(knowledge.gain, 0.03);
    EXPECT_EQ(knowledge.dynamic_index, 0);
    EXPECT_EQ(read_text("[knowledge]\nkt_n_per_m = 0.2\n").knowledge.ms_kg, 0.05);
    EXPECT_THAT(refusal_of_text("[knowledge]\n\nmass = 0.1\n"), HasSubstr("mine.toml:3: "));
    EXPECT_THAT(refusal_of_text("[knowledge]\ngain = 2\n"),
                HasSubstr("mine.toml:2: 'knowledge.gain' is '2', expected a number from 0 to 1"));
}

TEST(Recipe, RefusesWhatItDoesNotKnow) {
    EXPECT_THAT(refusal_of_text("[trips]\nnumber = 3\n"), HasSubstr("mine.toml:2: "));
    EXPECT_THAT(refusal_of_text("[trips]\nnumber = 3\n"), HasSubstr("number"));
    EXPECT_THAT(refusal_of_text("[weather]\n"), HasSubstr("mine.toml:1: "));
    EXPECT_THAT(refusal_of_text("[[road]]\n\niri = 3\n"), HasSubstr("mine.toml:3: "));
}

TEST(Recipe, SaysWhatIsWrongAndWhere) {
    EXPECT_THAT(refusal_of_text("[trips]\nlength_km = [9, 6]\n"),
                HasSubstr("expected two numbers, the first not above the second"));
    EXPECT_THAT(
        refusal_of_text("[trips]\nstop_share = 1.5\n"),
        HasSubstr("mine.toml:2: 'trips.stop_share' is '1.5', expected a number from 0 to 1"));
    EXPECT_THAT(refusal_of_text("[trips]\nfrom = \"spring\"\n"),
                HasSubstr("expected a day as in '2025-01-31'"));
    EXPECT_THAT(refusal_of_text("[trips]\nfrom = \"2025-02-01\"\nto = \"2025-01-01\"\n"),
                HasSubstr("mine.toml:3: "));
    EXPECT_THAT(refusal_of_text("[[car]]\nid = \"a b\"\n"),
                HasSubstr("expected letters of ASCII, digits, '-' and '_'"));
    EXPECT_THAT(refusal_of_text("[[car]]\nid = \"a\"\n[[car]]\nid = \"a\"\n"),
                HasSubstr("mine.toml:4: 'car.id' is 'a', expected another id for each car"));
    EXPECT_THAT(refusal_of_text("[[car]]\nid = \"a\"\nlike = \"truck\"\n"),
                HasSubstr("mine.toml:3: 'car.like' is 'truck', expected a built-in car"));
    EXPECT_THAT(refusal_of_text("[[car]]\nid = \"a\"\nsensors = [\"acc\", \"radar\"]\n"),
                HasSubstr("expected 'acc', and with it 'gyro' or 'speed' or both, each once"));
    EXPECT_THAT(refusal_of_text("[[car]]\nid = \"a\"\nsensors = [\"gyro\"]\n"),
                HasSubstr("expected 'acc', and with it"));
    EXPECT_THAT(refusal_of_text("[[road]]\niri_mm_per_m = 2\n"),
                HasSubstr("mine.toml:2: 'road.iri_mm_per_m' is '2', expected two numbers"));
    EXPECT_THAT(refusal_of_text("[[road]]\niri_mm_per_m = [60, 60]\n"),
                HasSubstr("mine.toml:2: 'road.iri_mm_per_m' is an array, expected two numbers, "
                          "the first not above the second, each a number from 0.01 to 50"));
    EXPECT_THAT(refusal_of_text("[trips]\nlength_km = [1e9, 1e9]\n"),
                HasSubstr("each a number from 0 to 300"));
    EXPECT_THAT(refusal_of_text("[[car]]\nid = \"a\"\nwheelbase_m = 1\ncg_to_front_m = 2\n"),
                HasSubstr("expected less than wheelbase_m"));
}
