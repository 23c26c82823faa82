#include "estimator/common/error.hpp"
#include "estimator/roughness/roughness_mean.hpp"
#include "estimator/smoother/smoothed_iri.hpp"

#include "driven_road.hpp"
#include "worlds.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Vehicle car() {
    return two_axle_car({.wheelbase_m = 2.7, .cg_to_front_m = 1.2}, 0.3);
}

TunedCar known_car() {
    return {.vehicle = car()};
}

/// A short drive of 130 m, every channel sampled.
const Stretch& short_stretch() {
    static const Stretch stretch =
        driven_road({.road = {.iri_mm_per_m = 2}, .car = linear_car_of(car()), .length_m = 140})
            .stretch;
    return stretch;
}

EstimatorConfig smoother_config(Channels channels = Channels::automatic) {
    EstimatorConfig config;
    config.method = Method::smoother;
    config.channels = channels;
    return config;
}

/// By some of its sensors, named.
IriRun run_by(const Stretch& stretch, const SensorSet& sensors) {
    auto config = smoother_config();
    config.sensors = sensors;
    return smoothed_iri(stretch, known_car(), config);
}

IriRun run_over(const Stretch& stretch, Channels channels = Channels::automatic) {
    return smoothed_iri(stretch, known_car(), smoother_config(channels));
}

Stretch first_samples(Stretch stretch, std::size_t count) {
    for (auto* channel : {&stretch.vertical_mps2,
                          &stretch.lateral_mps2,
                          &stretch.roll_radps,
                          &stretch.pitch_radps,
                          &stretch.yaw_radps,
                          &stretch.speed_mps}) {
        channel->resize(count);
    }
    stretch.travel_m.resize(count);
    return stretch;
}

bool is_roughness(float mm_per_m) {
    return std::isfinite(mm_per_m) && mm_per_m > 0 && mm_per_m < 100;
}

MATCHER(IsRoughness, "is a finite number between 0 and 100") {
    return is_roughness(arg);
}

std::vector<double> half_difference_m(const EstimatedProfile& profile) {
    std::vector<double> half_m;
    for (std::size_t i = 0; i < profile.left_m.size(); ++i) {
        half_m.push_back(static_cast<double>(profile.left_m[i] - profile.right_m[i]) / 2);
    }
    return half_m;
}

double cosine(const std::vector<double>& a, const std::vector<double>& b) {
    const auto product = [](const auto& x, const auto& y) {
        return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
    };
    return product(a, b) / std::sqrt(product(a, a) * product(b, b));
}

double mri_of(const IriRun& run, double from_m, double to_m) {
    return *mean_over({{run}, {}}, from_m, to_m, car()).mri_mm_per_m;
}

} // namespace

TEST(SmoothedIri, OfNothingIsNothing) {
    EXPECT_THAT(run_over(first_samples(short_stretch(), 0)).centre_mm_per_m, IsEmpty());
    EXPECT_THAT(run_over(first_samples(short_stretch(), 2)).centre_mm_per_m, IsEmpty());
    EXPECT_THAT(
        run_over(with_sensors(short_stretch(), {false, false, false, false})).centre_mm_per_m,
        IsEmpty());
}

/// From where the front wheels stand first to where the rear wheels stand last, in whole metres.
TEST(SmoothedIri, LiesWhereBothAxlesHaveBeen) {
    const auto& stretch = short_stretch();
    const auto run = run_over(stretch);
    EXPECT_EQ(run.start_travel_m, std::ceil(stretch.travel_m.front() + 1.2));
    const auto cells = static_cast<std::size_t>(
        4 * (std::floor(stretch.travel_m.back() - 1.5) - run.start_travel_m));
    EXPECT_THAT(run.left_mm_per_m, AllOf(SizeIs(cells), Each(IsRoughness())));
    EXPECT_THAT(run.right_mm_per_m, AllOf(SizeIs(cells), Each(IsRoughness())));
    EXPECT_THAT(run.centre_mm_per_m, AllOf(SizeIs(cells), Each(IsRoughness())));
    EXPECT_THAT(run.speed_mps, SizeIs(cells));
    EXPECT_NEAR(static_cast<double>(run.speed_mps[cells / 2]),
                static_cast<double>(stretch.speed_mps[stretch.speed_mps.size() / 2]),
                0.5);
}

TEST(SmoothedIri, ScattersOverWholeMetresOfTheRun) {
    const auto run = run_over(short_stretch());
    EXPECT_GE(run.scatter_mm_per_m.size(), 8);
    double sum = 0;
    for (const auto& road : run.scatter_mm_per_m) {
        ASSERT_THAT(road, SizeIs(run.centre_mm_per_m.size() / 4));
        sum += static_cast<double>(road[20]);
    }
    EXPECT_NEAR(sum, 0, 1e-4) << "about their mean";
}

TEST(SmoothedIri, OfAFewMetresIsShortAndFinite) {
    for (const std::size_t samples : {3U, 5U, 20U}) {
        const auto stretch = first_samples(short_stretch(), samples);
        const auto run = run_over(stretch);
        EXPECT_LE(static_cast<double>(run.centre_mm_per_m.size()) / 4,
                  std::max(0.0, stretch.travel_m.back() - stretch.travel_m.front()));
        EXPECT_THAT(run.centre_mm_per_m, Each(IsRoughness()));
        EXPECT_THAT(run.left_mm_per_m, SizeIs(run.centre_mm_per_m.size()));
    }
}

TEST(SmoothedIri, FromVerticalAloneKnowsNoTracks) {
    for (const Sensors sensors : {Sensors{true, false, false, false},
                                  Sensors{false, false, false, true},
                                  Sensors{true, false, false, true}}) {
        const auto run = run_over(with_sensors(short_stretch(), sensors));
        EXPECT_THAT(run.left_mm_per_m, IsEmpty());
        EXPECT_THAT(run.right_mm_per_m, IsEmpty());
        EXPECT_THAT(run.centre_mm_per_m, Each(IsRoughness()));
        EXPECT_FALSE(run.indicative);
    }
}

TEST(SmoothedIri, FromTheSidesAloneIsIndicative) {
    for (const Sensors sensors :
         {Sensors{false, true, false, false}, Sensors{false, false, true, false}}) {
        const auto run = run_over(with_sensors(short_stretch(), sensors));
        EXPECT_THAT(run.left_mm_per_m, IsEmpty());
        EXPECT_THAT(run.centre_mm_per_m, Each(IsRoughness()));
        EXPECT_TRUE(run.indicative);
        EXPECT_GE(run.common_sd, 0.2);
        EXPECT_EQ(mean_over({{run}, {}}, 80, 100, car()).validity, validity::indicative);
    }
}

TEST(SmoothedIri, TakesTheChannelsThatItIsTold) {
    const auto& all = short_stretch();
    const auto alone = run_over(with_sensors(all, {true, false, false, false}));
    EXPECT_EQ(run_over(all, Channels::vertical).centre_mm_per_m, alone.centre_mm_per_m);
    const auto lateral = with_sensors(all, {false, true, false, false});
    EXPECT_EQ(run_over(all, Channels::lateral).centre_mm_per_m, run_over(lateral).centre_mm_per_m);
}

TEST(SmoothedIri, TakesTheSensorsThatItIsTold) {
    const auto& all = short_stretch();
    const auto run = run_by(all, {.vertical = true, .roll = true});
    const auto alone = run_over(with_sensors(all, {true, false, true, false}));
    EXPECT_EQ(run.left_mm_per_m,
              run_by(with_sensors(all, {true, false, true, false}),
                     {.vertical = true, .roll = true, .pitch = true})
                  .left_mm_per_m);
    EXPECT_NE(run.left_mm_per_m, run_over(all).left_mm_per_m);
    EXPECT_THAT(alone.left_mm_per_m, SizeIs(run.left_mm_per_m.size()));
}

/// The headline of a map: roll serves the ratio of HRI to MRI alone, by the profile.
TEST(SmoothedIri, WithoutTracksTakesTheirDifferenceFromRollAndLeavesTheHeadlineAlone) {
    auto config = smoother_config();
    config.tracks = false;
    config.profile = true;
    const auto run = smoothed_iri(short_stretch(), known_car(), config);
    EXPECT_THAT(run.left_mm_per_m, IsEmpty());
    EXPECT_EQ(run.centre_mm_per_m,
              run_by(short_stretch(), {.vertical = true, .pitch = true}).centre_mm_per_m);

    config.sensors = {.vertical = true, .roll = true, .pitch = true, .yaw = true};
    const auto jointly = smoothed_iri(short_stretch(), known_car(), config);
    const auto apart_m = half_difference_m(run.profile);
    const auto jointly_m = half_difference_m(jointly.profile);
    ASSERT_THAT(apart_m, SizeIs(run.profile.centre_m.size()));
    ASSERT_THAT(jointly_m, SizeIs(apart_m.size()));
    EXPECT_GT(cosine(apart_m, jointly_m), 0.95); // 4 rounds beside 12 of all channels
}

TEST(SmoothedIri, WithTracksTakesLateralOnlyBesideRollAndAKnownHeight) {
    const auto& all = short_stretch();
    const SensorSet rates{.vertical = true, .roll = true, .pitch = true, .yaw = true};
    auto unknown_height = known_car();
    unknown_height.vehicle.imu.height_above_roll_axis_m = 0;
    auto by_rates = smoother_config();
    by_rates.sensors = rates;
    EXPECT_EQ(smoothed_iri(all, unknown_height, smoother_config()).left_mm_per_m,
              smoothed_iri(all, unknown_height, by_rates).left_mm_per_m);
    EXPECT_NE(run_over(all).left_mm_per_m, run_by(all, rates).left_mm_per_m);
    EXPECT_EQ(run_over(with_sensors(all, {true, true, false, true})).centre_mm_per_m,
              run_by(all, {.vertical = true, .pitch = true}).centre_mm_per_m);
}

TEST(SmoothedIri, OfACarWithoutAxlesIsOfTheVerticalAlone) {
    auto one_axle = known_car();
    one_axle.vehicle.axles.reset();
    const auto vertical = with_sensors(short_stretch(), {true, false, false, false});
    EXPECT_EQ(smoothed_iri(short_stretch(), one_axle, smoother_config()).centre_mm_per_m,
              smoothed_iri(vertical, one_axle, smoother_config()).centre_mm_per_m);
}

TEST(SmoothedIri, TakesTheGainOffAccelerationsAlone) {
    auto straight = short_stretch();
    straight.yaw_radps.clear(); // the pull of bends is what it is, whatever the gain
    auto louder = straight;
    for (auto* channel : {&louder.vertical_mps2, &louder.lateral_mps2}) {
        for (float& value : *channel) {
            value *= 2;
        }
    }
    auto doubled = known_car();
    doubled.vehicle.gain = 2;
    doubled.vehicle.imu.noise_mps2 *= 2;
    const auto run = smoothed_iri(louder, doubled, smoother_config());
    const auto plain = run_over(straight);
    EXPECT_NEAR(mri_of(run, 70, 120) / mri_of(plain, 70, 120), 1, 1e-4);
}

/// 30 mm high and 2 m long, on a road that is even but for it.
TEST(SmoothedIri, PutsABumpUnderTheWheelThatMetIt) {
    RoadUnderWheels road{.left_m = std::vector<float>(2800), .right_m = std::vector<float>(2800)};
    for (std::size_t i = 0; i < 40; ++i) {
        const double turn = 2 * std::numbers::pi * static_cast<double>(i) / 40;
        road.left_m[1800 + i] = static_cast<float>(0.015 * (1 - std::cos(turn)));
    }
    const DriveRecipe recipe{.road = {}, .car = linear_car_of(car()), .length_m = 140};
    const auto on_left = run_over(stretch_over(road, recipe));
    std::swap(road.left_m, road.right_m);
    const auto on_right = run_over(stretch_over(road, recipe));
    const auto over = [](const IriRun& run) { return mean_over({{run}, {}}, 80, 110, car()); };
    EXPECT_GT(*over(on_left).left_mm_per_m, 2 * *over(on_left).right_mm_per_m);
    EXPECT_GT(*over(on_right).right_mm_per_m, 2 * *over(on_right).left_mm_per_m);
}

TEST(SmoothedIri, IsStartingUpBeforeItsLeadIn) {
    const auto run = run_over(short_stretch());
    const IriTrace trace{{run}, {}};
    EXPECT_EQ(mean_over(trace, 20, 40, car()).validity, validity::start_up);
    EXPECT_EQ(mean_over(trace, 80, 100, car()).validity, validity::ok);
    EXPECT_EQ(mean_over(trace, 120, 160, car()).validity, validity::gap);
    EXPECT_EQ(mean_over({{run}, {{150, 190}}}, 160, 180, car()).validity, validity::too_slow);
}

TEST(SmoothedIri, IsTheSameAgain) {
    const auto one = run_over(short_stretch());
    const auto two = run_over(short_stretch());
    EXPECT_EQ(one.left_mm_per_m, two.left_mm_per_m);
    EXPECT_EQ(one.scatter_mm_per_m, two.scatter_mm_per_m);
}

TEST(CarIn, ATooShortStretchIsTheVehicleItselfAndNotWellKnown) {
    const auto tuned = car_in(short_stretch(), {.vehicle = car()}, smoother_config());
    EXPECT_EQ(tuned.vehicle.half_car.cs_ns_per_m, car().half_car.cs_ns_per_m);
    EXPECT_EQ(tuned.friction_n, usual_friction_n(car().half_car).mean);
    EXPECT_EQ(tuned.iri_sd, 0.1);
}

TEST(CarIn, IsNotTunedAfterAStopRequest) {
    const auto drive =
        driven_road({.road = {.iri_mm_per_m = 2}, .car = linear_car_of(car()), .length_m = 1300});
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(car_in(drive.stretch, {.vehicle = car()}, smoother_config(), stop.get_token()),
                 InputError);
}

} // namespace macadam::testing
