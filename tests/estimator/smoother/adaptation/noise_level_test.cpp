#include "estimator/smoother/adaptation/noise_level.hpp"

#include "estimator/smoother/driven_road.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace macadam::testing {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::IsEmpty;

constexpr double step_s = 0.02;
constexpr int rounds = 60; // until nothing moves
constexpr double stated_weight = 0.3;

/// Readings of a number with a prior of its own at every sample, y = x + noise: what is left of the
/// first channel under noise of a stated variance times the factors, on average.
Residual left_over(const std::vector<double>& factors,
                   std::size_t samples,
                   double prior,
                   double stated,
                   const std::vector<double>& true_noise) {
    Residual residual;
    for (std::size_t k = 0; k < samples; ++k) {
        const double r = stated * (factors.empty() ? 1 : factors[k]);
        const double s = prior + r;
        residual.seen.push_back(static_cast<float>(r * (prior + true_noise[k]) / (s * s)));
        residual.open.push_back(static_cast<float>(prior / s));
    }
    return residual;
}

/// The factors at which the rounds settle.
std::vector<double> settled(double prior, double stated, const std::vector<double>& true_noise) {
    NoiseFactors factors;
    for (int round = 0; round < rounds; ++round) {
        std::array<Residual, channel_count> residual;
        residual[0] = left_over(factors[0], true_noise.size(), prior, stated, true_noise);
        factors = adapted(std::move(factors), residual, step_s);
    }
    return factors[0];
}

/// Where the share s of a reading that is known to be noise says `found` and the file says 1:
/// s (found / f - 1) = -0.3 (1 / f - 1), by bisection.
double between(double prior, double stated, double true_noise) {
    const auto excess = [=](double f) {
        const double r = f * stated;
        return r * (prior + true_noise) / ((prior + r) * (prior + r)) - r / (prior + r) +
               stated_weight * (1 / f - 1);
    };
    double low = 0.1;
    double high = 100;
    for (int i = 0; i < 100; ++i) {
        (excess((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    }
    return low;
}

const std::vector<double>& even(double variance) {
    static std::vector<double> noise;
    noise.assign(2000, variance);
    return noise;
}

/// Mean factor of a channel after the smoother's rounds over a drive whose sensors are as many
/// times worse than their file says.
double found_in_a_drive(double times_worse, std::size_t channel) {
    auto vehicle = two_axle_car({.wheelbase_m = 2.7, .cg_to_front_m = 1.2}, 0.3);
    const auto driven = driven_road({.road = {.iri_mm_per_m = 2},
                                     .car = linear_car_of(vehicle),
                                     .imu = {.rate_hz = 50,
                                             .noise_mps2 = times_worse * vehicle.imu.noise_mps2,
                                             .noise_radps = times_worse * vehicle.imu.noise_radps},
                                     .length_m = 250});
    const auto stretch = with_sensors(driven.stretch, {true, false, false, true});
    const auto road = smooth_drives({exact_drive(stretch, vehicle)}, {});
    const auto& factors = road.noise[0][channel];
    return std::accumulate(factors.begin(), factors.end(), 0.0) /
           static_cast<double>(factors.size());
}

} // namespace

TEST(NoiseLevel, StaysWhereReadingsAreAsNoisyAsStated) {
    for (const double prior : {0.0, 0.3, 1.0, 30.0}) {
        EXPECT_THAT(settled(prior, 0.5, even(0.5)), Each(DoubleNear(1, 1e-5))) << prior;
    }
}

/// Nothing but noise: the mean of what was seen and of what was stated, by their weights.
TEST(NoiseLevel, OfNoiseAloneLiesBetweenWhatIsSeenAndWhatIsStated) {
    EXPECT_THAT(settled(0, 0.5, even(2)), Each(DoubleNear((4 + 0.3) / 1.3, 1e-4)));
}

TEST(NoiseLevel, SettlesWhereTheLikelihoodAndTheFileBalance) {
    for (const double prior : {0.1, 0.5, 2.0}) {
        const double expected = between(prior, 0.5, 2);
        EXPECT_GT(expected, 1.5);
        EXPECT_THAT(settled(prior, 0.5, even(2)), Each(DoubleNear(expected, 1e-4))) << prior;
    }
}

TEST(NoiseLevel, KeepsToWhatIsStatedWhereNothingTellsNoiseFromRoad) {
    EXPECT_THAT(settled(1e6, 0.5, even(5)), Each(DoubleNear(1, 0.001)));
}

TEST(NoiseLevel, BelievesNoSensorMuchBetterThanStated) {
    EXPECT_THAT(settled(0, 0.5, even(0.01)), Each(0.8));
}

TEST(NoiseLevel, FollowsAMountThatBeginsToShake) {
    std::vector<double> noise(4000, 0.5);
    std::fill(noise.begin() + 2000, noise.end(), 8);
    const auto factors = settled(0, 0.5, noise);
    // Rounds make the edge of the window ring by some percent.
    EXPECT_NEAR(factors[1500], 1, 0.05) << "ten seconds before";
    EXPECT_NEAR(factors[2500] / ((16 + 0.3) / 1.3), 1, 0.1) << "ten seconds after";
    EXPECT_GT(factors[2000], 3);
    EXPECT_LT(factors[2000], 10);
}

TEST(NoiseLevel, OfChannelsThatWereNotFeltIsNothing) {
    const auto factors = adapted({}, {}, step_s);
    EXPECT_THAT(factors, Each(IsEmpty()));
}

TEST(NoiseLevel, MultipliesTheVariancesOfItsChannelAlone) {
    NoiseFactors factors;
    factors[2] = {2, 3};
    const auto variances = times({{{1, 1}, {1, 1}, {5, 7}, {}}}, factors);
    EXPECT_THAT(variances[0], Each(1));
    EXPECT_THAT(variances[2], ::testing::ElementsAre(10, 21));
    EXPECT_THAT(variances[3], IsEmpty());
}

/// Four times the variance: the weight of 0.3 of what is stated leaves 3.3 of it where all of a
/// reading is known to be noise, and less where the road takes its share.
TEST(NoiseLevel, OfADriveWithSensorsTwiceAsNoisyAsStatedIsFound) {
    for (const std::size_t channel : {0U, 3U}) {
        EXPECT_NEAR(found_in_a_drive(1, channel), 1, 0.2) << channel;
        const double found = found_in_a_drive(2, channel);
        EXPECT_GT(found, 1.6) << channel;
        EXPECT_LT(found, 3.5) << channel;
    }
}

} // namespace macadam::testing
