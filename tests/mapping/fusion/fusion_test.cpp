#include "mapping/fusion/fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam {
namespace {

constexpr std::int64_t day_ms = 86'400'000;

/// A pass of a trip of its own.
FusionInput reading(IriUm iri_um, IriUm sd_um, std::int64_t vehicle) {
    static int trip = 1'000'000;
    FusionInput input{};
    input.pass.segment = {1, true, 0};
    input.pass.iri_um = iri_um;
    input.pass.sd_um = sd_um;
    input.vehicle = vehicle;
    input.trip_sha256 = std::to_string(++trip);
    return input;
}

std::vector<FusionInput> of_many_cars(const std::vector<IriUm>& readings, IriUm sd_um) {
    std::vector<FusionInput> passes;
    for (const auto iri_um : readings) {
        passes.push_back(reading(iri_um, sd_um, static_cast<std::int64_t>(passes.size())));
    }
    return passes;
}

double between_um(double level_um) {
    return std::hypot(0.08 * level_um, 50);
}

/// Factor on the errors that cars do not share, of cars that read the same.
double agreed(int cars) {
    return std::sqrt(12.0 / (12 + cars - 1));
}

TEST(Fusion, OfOnePassIsThatPassWithTheScatterBetweenPasses) {
    const auto state = fuse(of_many_cars({2000}, 300), {});
    const double sd_um = std::hypot(300, between_um(2000));
    EXPECT_EQ(state.iri_um, 2000);
    EXPECT_NEAR(state.sd_um, sd_um, 0.5); // rounding
    EXPECT_NEAR(state.low_um, 2000 - 1.645 * sd_um, 0.5);
    EXPECT_NEAR(state.high_um, 2000 + 1.645 * sd_um, 0.5);
    EXPECT_EQ(state.passes, 1);
    EXPECT_EQ(state.vehicles, 1);
}

TEST(Fusion, OfEqualPassesOfManyCarsShrinksToWhatAllCarsShare) {
    const auto state = fuse(of_many_cars(std::vector<IriUm>(9, 2000), 200), {});
    EXPECT_EQ(state.iri_um, 2000);
    const double of_each = agreed(9) * std::hypot(200 * std::sqrt(0.5), between_um(2000));
    EXPECT_NEAR(state.sd_um, std::hypot(of_each / 3, 200 * std::sqrt(0.5)), 0.5);
    EXPECT_EQ(state.vehicles, 9);
}

TEST(Fusion, ShrinksTheSdWhereCarsAgreeButNotWherePassesOfOneCarDo) {
    const std::vector<IriUm> readings{1900, 1950, 2000, 2050, 2100};
    auto passes = of_many_cars(readings, 200);
    const double of_car = std::hypot(200 * std::sqrt(0.5), between_um(2000));
    double strangeness = 0;
    for (const auto iri_um : readings) {
        strangeness += std::pow((iri_um - 2000) / of_car, 2);
    }
    const double factor = std::sqrt((12 + strangeness) / (12 + 4));
    EXPECT_NEAR(fuse(passes, {}).sd_um,
                std::hypot(factor * of_car / std::sqrt(5), 200 * std::sqrt(0.5)),
                3); // the t distribution weighs them a little
    for (auto& input : passes) {
        input.vehicle = 1;
    }
    EXPECT_NEAR(fuse(passes, {}).sd_um, std::hypot(200, between_um(2000) / std::sqrt(5)), 3);
}

TEST(Fusion, OfManyUnknownCarsShrinksToWhatUnknownCarsShare) {
    // Half of (35 %)^2 would be (25 %)^2, but all unknown cars together err by 7 % and 0.08 mm/m.
    const auto state = fuse(of_many_cars(std::vector<IriUm>(400, 2000), 700), {});
    const double common_um = std::hypot(0.07 * 2000, 80);
    const double of_each =
        agreed(400) * std::hypot(std::sqrt(700 * 700 - common_um * common_um), between_um(2000));
    EXPECT_NEAR(state.sd_um, std::hypot(common_um, of_each / 20), 0.5);
    EXPECT_NEAR(fuse(of_many_cars({2000}, 700), {}).sd_um, std::hypot(700, between_um(2000)), 0.5);
}

TEST(Fusion, OfManyCarsByLateralVibrationAloneIsOffByHalfTheirVariance) {
    auto passes = of_many_cars(std::vector<IriUm>(400, 2000), 700);
    for (auto& input : passes) {
        input.pass.validity = validity::indicative | validity::lateral_alone;
    }
    const double of_each = agreed(400) * std::hypot(700 * std::sqrt(0.5), between_um(2000));
    EXPECT_NEAR(fuse(passes, {}).sd_um, std::hypot(700 * std::sqrt(0.5), of_each / 20), 0.5);
}

TEST(Fusion, LetsOnePassOfThePublishedFilterWidenNoOther) {
    auto passes = of_many_cars(std::vector<IriUm>(100, 2000), 700);
    const auto limited_um = fuse(passes, {}).sd_um;
    passes.front().by_filter = true;
    EXPECT_LT(fuse(passes, {}).sd_um, 1.03 * limited_um); // one of a hundred, by 495 against 161 um
    for (auto& input : passes) {
        input.by_filter = true;
    }
    EXPECT_GT(fuse(passes, {}).sd_um, 700 * std::sqrt(0.5));
}

TEST(Fusion, OfOneCarThatChangedDoesNotAgreeWithItself) {
    auto passes = of_many_cars(std::vector<IriUm>(40, 2000), 200);
    for (std::size_t i = 0; i < passes.size(); ++i) {
        passes[i].vehicle = 7;
        passes[i].period = static_cast<std::uint32_t>(i % 2);
    }
    const double of_periods = std::hypot(200 * std::sqrt(0.5), 200 * std::sqrt(0.5) / std::sqrt(2));
    EXPECT_NEAR(fuse(passes, {}).sd_um, of_periods, 0.05 * of_periods);
}

TEST(Fusion, OfOneCarNeverKnowsMoreThanThatCar) {
    auto passes = of_many_cars(std::vector<IriUm>(10000, 2000), 300);
    for (auto& pass : passes) {
        pass.vehicle = 7;
    }
    EXPECT_NEAR(fuse(passes, {}).sd_um, 300, 1); // between_um / 100 is left of the scatter
}

TEST(Fusion, OfTwoEqualWeightsIsTheirMean) {
    EXPECT_EQ(fuse(std::vector{reading(1800, 180, 1), reading(2400, 240, 2)}, {}).iri_um, 2100);
}

TEST(Fusion, GivesNoWeightForReadingLow) {
    // Every car claims a fifth of what it read; one in three, then four in twenty, read a fifth.
    EXPECT_NEAR(
        fuse(std::vector{reading(2300, 460, 1), reading(2350, 470, 2), reading(460, 92, 3)}, {})
            .iri_um,
        2300,
        120);
    std::vector<FusionInput> passes;
    for (int i = 0; i < 20; ++i) {
        const IriUm iri_um = i % 5 == 0 ? 460 : 2200 + 10 * i;
        passes.push_back(reading(iri_um, iri_um / 5, i));
    }
    EXPECT_NEAR(fuse(passes, {}).iri_um, 2300, 120);
}

TEST(Fusion, LetsOneBadPassAmongFiveMoveTheStateByLessThanThreePercent) {
    for (const IriUm sd_um : {100, 200, 400, 800}) {
        for (const double gain : {1.5, 1 / 1.5}) {
            const auto bad = static_cast<IriUm>(2000 * gain);
            const auto state = fuse(of_many_cars({2000, 2000, bad, 2000, 2000}, sd_um), {});
            EXPECT_NEAR(state.iri_um, 2000, 60) << "sd " << sd_um << ", gain " << gain;
        }
    }
}

TEST(Fusion, TrustsTheSurerPassMore) {
    const std::vector passes{reading(2000, 100, 1), reading(2200, 600, 2)};
    const double a = 1 / (100 * 100 + std::pow(between_um(2100), 2));
    const double b = 1 / (600 * 600 + std::pow(between_um(2100), 2));
    // Both lie well within their sd: the heavy tail moves the weights by a few per cent.
    EXPECT_NEAR(fuse(passes, {}).iri_um, (a * 2000 + b * 2200) / (a + b), 6);
}

/// -log of the posterior that the weights of fuse() minimise: Student's t about the mean with each
/// pass's own weight and the scale by which it is judged.
double misfit(const std::vector<FusionInput>& passes, double mean_um) {
    const double scatter_um = 1.4826 * 150; // median 2050; deviations 0, 50, 150, 200, 850
    const double rest = std::pow(between_um(2050), 2);
    double sum = 0;
    for (const auto& input : passes) {
        const double sd2 = std::pow(input.pass.sd_um * 2050.0 / input.pass.iri_um, 2);
        const double strange2 = rest + std::min(sd2, scatter_um * scatter_um);
        const double r2 = std::pow(input.pass.iri_um - mean_um, 2) / strange2;
        sum += strange2 / (sd2 + rest) * std::log1p(r2 / 4);
    }
    return sum;
}

TEST(Fusion, FindsTheMinimumThatATrialOfEveryMeanFinds) {
    const std::vector passes{reading(2000, 195, 1),
                             reading(2050, 200, 2),
                             reading(1900, 185, 3),
                             reading(2250, 220, 4),
                             reading(2900, 283, 5)};
    double best_um = 1500;
    for (double mean_um = 1500; mean_um <= 3000; mean_um += 0.25) {
        if (misfit(passes, mean_um) < misfit(passes, best_um)) {
            best_um = mean_um;
        }
    }
    EXPECT_NEAR(fuse(passes, {}).iri_um, best_um, 0.7); // half a step and half a unit
}

TEST(Fusion, IsTheSameForEveryOrderOfImport) {
    // Order of passes is fixed by trip hash; what an import changes is the numbers of the vehicles.
    std::mt19937 random{7};
    std::uniform_int_distribution<IriUm> iri{1500, 4000};
    std::vector<FusionInput> passes;
    for (int i = 0; i < 40; ++i) {
        passes.push_back(reading(iri(random), 100 + 10 * i, i % 7));
    }
    const auto state = fuse(passes, {});
    std::vector<std::int64_t> numbers{0, 1, 2, 3, 4, 5, 6};
    for (int round = 0; round < 50; ++round) {
        std::shuffle(numbers.begin(), numbers.end(), random);
        auto renumbered = passes;
        for (auto& pass : renumbered) {
            pass.vehicle = 1000 - numbers[static_cast<std::size_t>(pass.vehicle)];
        }
        EXPECT_EQ(fuse(renumbered, {}), state);
    }
}

TEST(Fusion, GrowsTheSdWherePassesDisagree) {
    const auto agreed = fuse(of_many_cars({2000, 2000, 2000, 2000}, 50), {});
    const auto torn = fuse(
        std::vector{
            reading(1000, 25, 0), reading(3000, 75, 1), reading(1000, 25, 2), reading(3000, 75, 3)},
        {});
    EXPECT_GT(torn.sd_um, 3 * agreed.sd_um); // they lie 6 sd from their mean
}

TEST(Fusion, NeverPutsTheLowEndBelowZero) {
    const auto state = fuse(of_many_cars({100}, 500), {});
    EXPECT_EQ(state.low_um, 0);
    EXPECT_GT(state.high_um, 800);
}

TEST(Fusion, MeansLeftAndRightWithTheWeightsOfTheHeadline) {
    auto passes = of_many_cars({2000, 2000, 2000}, 100);
    for (auto& input : passes) {
        input.pass.iri_left_um = 2300;
        input.pass.iri_right_um = 1700;
    }
    passes[1].pass.iri_left_um.reset();
    const auto state = fuse(passes, {});
    EXPECT_EQ(state.left_um, 2300);
    EXPECT_EQ(state.right_um, 1700);
    EXPECT_EQ(fuse(of_many_cars({2000}, 100), {}).left_um, std::nullopt);
}

TEST(Fusion, IsCentreOnlyAndFlaggedOnlyWhereEveryPassIs) {
    auto passes = of_many_cars({2000, 2000}, 100);
    for (auto& input : passes) {
        input.pass.centre_only = true;
        input.pass.validity = 8;
    }
    EXPECT_TRUE(fuse(passes, {}).centre_only);
    EXPECT_EQ(fuse(passes, {}).validity, 8);
    passes[0].pass.centre_only = false;
    passes[0].pass.validity = 2;
    EXPECT_FALSE(fuse(passes, {}).centre_only);
    EXPECT_EQ(fuse(passes, {}).validity, 0);
}

TEST(Fusion, FindsTheTrendOfDatedPasses) {
    std::vector<FusionInput> passes;
    for (int quarter = 0; quarter < 12; ++quarter) {
        passes.push_back(reading(2000 + 25 * quarter, 100, quarter));
        passes.back().utc_ms = static_cast<std::int64_t>(quarter * 0.25 * 365.25 * day_ms);
    }
    passes.push_back(reading(2100, 100, 99)); // not dated: says nothing of the trend
    const auto state = fuse(passes, {});
    EXPECT_EQ(state.trend_um_per_year, 100);
    EXPECT_EQ(state.first_seen_ms, 0);
    EXPECT_EQ(state.last_seen_ms, static_cast<std::int64_t>(2.75 * 365.25 * day_ms));
}

TEST(Fusion, SeesNoTrendWithinAYear) {
    auto passes = of_many_cars({2000, 2500}, 100);
    passes[0].utc_ms = 0;
    passes[1].utc_ms = 365 * day_ms;
    EXPECT_EQ(fuse(passes, {}).trend_um_per_year, std::nullopt);
    passes[1].utc_ms.reset();
    EXPECT_EQ(fuse(passes, {}).last_seen_ms, 0);
}

} // namespace
} // namespace macadam
