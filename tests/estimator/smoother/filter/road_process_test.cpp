#include "estimator/smoother/filter/road_process.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

constexpr double cell_m = 0.25;

RoadPrior prior_of(std::vector<double> change_weights, const RoadGrid& grid) {
    RoadPrior prior;
    prior.change_weights = std::move(change_weights);
    prior.increments.assign(grid.cells, {2e-6, 8e-7, 3e-7});
    return prior;
}

RoadGrid grid_of(std::size_t cells) {
    return {cell_m, -40, cells};
}

double keep(double length_m) {
    return std::exp(-cell_m / length_m);
}

/// A road that changes by a metre at one station, both sides of it, and never again.
std::vector<Pair> after_a_change(const RoadPrior& prior, const RoadGrid& grid, std::size_t at) {
    std::vector<Pair> increments(grid.cells);
    increments[at] = {1, 1};
    return profile_of(increments, road_processes(prior, grid.cell_m));
}

/// Spectrum of the mean's elevation at a wave number, over the increments', from what one change
/// becomes.
double spectrum_of(const RoadPrior& prior, double per_m) {
    const auto grid = grid_of(4000); // a kilometre: what 30 m forget is gone
    const auto road = after_a_change(prior, grid, 2);
    std::complex<double> sum = 0;
    for (std::size_t i = 2; i < road.size(); ++i) {
        sum += road[i].mean *
               std::polar(1.0, -2 * std::numbers::pi * per_m * cell_m * static_cast<double>(i - 2));
    }
    return std::norm(sum);
}

} // namespace

/// The autoregression of the changes, of a road that forgets: one filter after the other.
TEST(RoadProcess, HasTheSpectrumOfItsAutoregression) {
    for (const std::vector<double>& weights : {std::vector<double>{},
                                               {0.4},
                                               {0.5, -0.3, 0.1},
                                               {0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.3}}) {
        const auto prior = prior_of(weights, grid_of(4000));
        for (const double per_m : {0.005, 0.05, 0.4, 1.3, 2.0}) {
            const auto z = std::polar(1.0, -2 * std::numbers::pi * per_m * cell_m);
            std::complex<double> changes = 1;
            for (std::size_t i = 0; i < weights.size(); ++i) {
                changes -= weights[i] * std::pow(z, static_cast<double>(i + 1));
            }
            const double expected = 1 / std::norm((1.0 - keep(30) * z) * changes);
            EXPECT_NEAR(spectrum_of(prior, per_m) / expected, 1, 1e-9)
                << weights.size() << " weights, " << per_m << " waves a metre";
        }
    }
}

TEST(RoadProcess, LeavesHalfTheDifferenceARandomWalkThatForgets) {
    const auto grid = grid_of(60);
    const auto road = after_a_change(prior_of({0.6, 0.1}, grid), grid, 5);
    for (std::size_t i = 5; i < grid.cells; ++i) {
        EXPECT_NEAR(road[i].half, std::pow(keep(4), static_cast<double>(i - 5)), 1e-12);
    }
}

/// Before the second station there is no change that could go on.
TEST(RoadProcess, KnowsNoChangeBeforeItsFirst) {
    const auto grid = grid_of(10);
    const auto road = after_a_change(prior_of({0.6, 0.2}, grid), grid, 0);
    EXPECT_NEAR(road[1].mean, keep(30), 1e-12);
    EXPECT_NEAR(road[2].mean, keep(30) * keep(30), 1e-12)
        << "the first station's height is no change";
}

TEST(RoadProcess, IsAsHighAtItsFirstStationAsEverAfter) {
    const auto grid = grid_of(50);
    const auto prior = prior_of({}, grid);
    const auto first = first_increment(prior, grid);
    const Increment q = prior.increments.front();
    EXPECT_NEAR(first.mean, keep(30) * keep(30) * first.mean + q.mean, 1e-12 * first.mean);
    EXPECT_NEAR(first.half, keep(4) * keep(4) * first.half + q.half, 1e-12 * first.half);
}

TEST(RoadProcess, OfFewerStationsThanItLooksBackIsStillOne) {
    const auto road = after_a_change(prior_of({0.5, 0.1}, grid_of(1)), grid_of(1), 0);
    ASSERT_EQ(road.size(), 1);
    EXPECT_EQ(road[0].mean, 1);
}

/// Two normal numbers are mapped by a matrix; its square is the covariance.
TEST(DrawnIncrement, HasTheCovarianceThatIsAskedFor) {
    for (const Increment q :
         {Increment{2e-6, 8e-7, 3e-7}, Increment{1e-6, 4e-6, -1.9e-6}, Increment{3e-6, 1e-6, 0}}) {
        const Pair one = drawn_increment(q, 1, 0);
        const Pair two = drawn_increment(q, 0, 1);
        EXPECT_NEAR(one.mean * one.mean + two.mean * two.mean, q.mean, 1e-18);
        EXPECT_NEAR(one.half * one.half + two.half * two.half, q.half, 1e-18);
        EXPECT_NEAR(one.mean * one.half + two.mean * two.half, q.cross, 1e-18);
    }
}

} // namespace macadam::testing
