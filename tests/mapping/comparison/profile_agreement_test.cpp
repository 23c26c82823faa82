#include "mapping/comparison/profile_agreement.hpp"

#include "estimator/common/error.hpp"
#include "estimator/iri/iri.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace macadam;
using ::testing::HasSubstr;

namespace {

/// Road of 200 waves of random phase, defined at every station: a slope as white as a real road's.
class Road {
public:
    explicit Road(std::uint64_t seed) {
        std::mt19937_64 random{seed};
        std::uniform_real_distribution<double> turn{0, 2 * std::numbers::pi};
        for (int i = 0; i < 200; ++i) {
            const double wavelength_m = 0.4 * std::pow(100.0, i / 199.0); // 0.4 to 40 m
            waves_.push_back(
                {2 * std::numbers::pi / wavelength_m, wavelength_m * 2e-4, turn(random)});
        }
    }

    std::vector<double> elevation_m(double from_m, double step_m, std::size_t count) const {
        std::vector<double> elevation(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double at_m = from_m + static_cast<double>(i) * step_m;
            for (const auto& [number, height_m, phase] : waves_) {
                elevation[i] += height_m * std::sin(number * at_m + phase);
            }
        }
        return elevation;
    }

private:
    struct Wave {
        double number, height_m, phase;
    };
    std::vector<Wave> waves_;
};

constexpr double step_m = 0.05;
constexpr std::size_t count = 4000;

TrackAgreement compared(const std::vector<double>& a, const std::vector<double>& b) {
    return compare_tracks({a, 0, step_m}, {b, 0, step_m}, 0, {});
}

} // namespace

TEST(ProfileAgreement, IsOneForEqualProfilesInEveryBand) {
    const auto road = Road{1}.elevation_m(0, step_m, count);
    const auto agreement = compared(road, road);
    ASSERT_EQ(agreement.bands.size(), 4U);
    for (const auto& band : agreement.bands) {
        EXPECT_NEAR(band.score, 1, 1e-9) << band.band.name;
        EXPECT_NEAR(band.gain, 1, 1e-9) << band.band.name;
        EXPECT_NEAR(band.lag_m, 0, 1e-6) << band.band.name;
    }
    EXPECT_DOUBLE_EQ(agreement.iri_a, agreement.iri_b);
}

TEST(ProfileAgreement, FindsALagBetweenThePoints) {
    // The features of the second profile lie 1.32 m further along: 26.4 steps.
    const Road road{2};
    const auto agreement =
        compared(road.elevation_m(0, step_m, count), road.elevation_m(-1.32, step_m, count));
    ASSERT_EQ(agreement.bands.size(), 4U);
    for (const auto& band : agreement.bands) {
        // The parabola's error, and for waves of 8 to 40 m the filter's ends.
        EXPECT_NEAR(band.lag_m, 1.32, band.band.name == "long" ? 0.1 : 0.02) << band.band.name;
        EXPECT_GT(band.score, 0.98) << band.band.name; // ends and the parabola
    }
}

TEST(ProfileAgreement, LosesTheRatioOfAmplitudesToAGain) {
    const auto road = Road{3}.elevation_m(0, step_m, count);
    auto higher = road;
    for (auto& z : higher) {
        z *= 1.25;
    }
    const auto agreement = compared(higher, road);
    ASSERT_EQ(agreement.bands.size(), 4U);
    for (const auto& band : agreement.bands) {
        EXPECT_NEAR(band.correlation, 1, 1e-9) << band.band.name;
        EXPECT_NEAR(band.gain, 1.25, 1e-9) << band.band.name;
        EXPECT_NEAR(band.score, 1 / 1.25, 1e-4) << band.band.name;
    }
    EXPECT_NEAR(agreement.iri_a / agreement.iri_b, 1.25, 1e-9);
    EXPECT_EQ(compared(road, higher).bands.front().score, agreement.bands.front().score);
}

TEST(ProfileAgreement, SeesAnErrorOnlyInItsBand) {
    // A wave of 0.8 m, about as strong as the road in the short band.
    const auto road = Road{4}.elevation_m(0, step_m, count);
    auto wavy = road;
    for (std::size_t i = 0; i < count; ++i) {
        wavy[i] += 6e-4 * std::sin(2 * std::numbers::pi * static_cast<double>(i) * step_m / 0.8);
    }
    const auto agreement = compared(wavy, road);
    ASSERT_EQ(agreement.bands.size(), 4U);
    EXPECT_GT(agreement.bands[1].score, 0.99); // long: leakage
    EXPECT_GT(agreement.bands[2].score, 0.98); // medium: the edge of the filter
    EXPECT_LT(agreement.bands[3].score, 0.8);  // short
}

TEST(ProfileAgreement, OfUnrelatedProfilesIsLow) {
    const auto agreement =
        compared(Road{5}.elevation_m(0, step_m, count), Road{6}.elevation_m(0, step_m, count));
    EXPECT_LT(agreement.bands.front().score, 0.4); // the best of 200 lags of 189 m
}

TEST(ProfileAgreement, GivesTheIriOfTheSharedRoadAndOfItsIntervals) {
    const auto road = Road{7}.elevation_m(0, step_m, count);
    const auto agreement = compared(road, road);
    const auto stroke = rectified_stroke_mm_per_m(road, step_m);
    double sum = 0;
    for (std::size_t i = 220; i < stroke.size(); ++i) { // from 11 m on
        sum += stroke[i];
    }
    // Between grid points the signal is interpolated, which takes a little of its peaks.
    EXPECT_NEAR(
        agreement.iri_a, sum / static_cast<double>(stroke.size() - 220), 0.02 * agreement.iri_a);
    EXPECT_EQ(agreement.intervals.size(), 9U); // of 20 m in 200 m less 11 m and the envelope
    EXPECT_NEAR(agreement.shared_m, 188.7, 0.2);
}

TEST(ProfileAgreement, ComparesProfilesOfOtherStepsAndLeavesBandsOutThatTheyCannotHold) {
    const Road road{8};
    const auto fine = road.elevation_m(0, 0.025, 8000);
    const auto coarse = road.elevation_m(0, 0.25, 800);
    const auto agreement = compare_tracks({fine, 0, 0.025}, {coarse, 0, 0.25}, 0, {});
    ASSERT_EQ(agreement.bands.size(), 3U); // 0.32 m waves need points every 0.16 m
    EXPECT_EQ(agreement.bands.back().band.name, "medium");
    EXPECT_GT(agreement.bands[1].score, 0.98);
}

TEST(ProfileAgreement, RefusesProfilesThatShareNoRoad) {
    const auto road = Road{9}.elevation_m(0, step_m, count);
    try {
        compare_tracks({road, 0, step_m}, {road, 500, step_m}, 0, {});
        FAIL() << "expected a refusal";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("share less than 20 m of road"));
    }
}

TEST(ProfileAgreement, ComparesVeryFineProfilesEveryCentimetre) {
    const Road road{10};
    const auto fine = road.elevation_m(0, 0.002, 40000);
    const auto agreement = compare_tracks({fine, 0, 0.002}, {fine, 0, 0.002}, 0, {});
    ASSERT_EQ(agreement.bands.size(), 4U);
    EXPECT_NEAR(agreement.bands.front().score, 1, 1e-9);
    const double points = agreement.shared_m / 0.01;
    EXPECT_NEAR(points, std::round(points), 1e-6);
}

TEST(ProfileAgreement, OfTwoPlanesIsOneWhateverTheirRounding) {
    std::vector<double> flat, steep;
    for (std::size_t i = 0; i < count; ++i) {
        flat.push_back(300 + 0.01 * static_cast<double>(i) * step_m);
        steep.push_back(0.07 * static_cast<double>(i) * step_m);
    }
    const auto agreement = compared(flat, steep);
    EXPECT_EQ(agreement.bands.front().score, 1);
    EXPECT_EQ(agreement.bands.front().gain, 1);
}

TEST(ProfileAgreement, RefusesStepsAndElevationsOutOfBounds) {
    const auto refusal = [](const std::vector<double>& elevation_m, double of_step_m) {
        try {
            compare_tracks({elevation_m, 0, of_step_m}, {elevation_m, 0, of_step_m}, 0, {});
        } catch (const InputError& error) {
            return std::string{error.what()};
        }
        return std::string{};
    };
    auto road = Road{11}.elevation_m(0, step_m, count);
    EXPECT_EQ(refusal(road, 5e-5), "profile step is 5e-05 m, expected at least 0.0001");
    road[7] = -2e6;
    EXPECT_EQ(refusal(road, step_m),
              "elevation 8 of a profile is -2e+06 m, expected at most 100000 m above or below 0");
}
