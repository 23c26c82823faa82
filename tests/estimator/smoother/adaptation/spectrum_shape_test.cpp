#include "estimator/smoother/adaptation/spectrum_shape.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

constexpr double cell_m = 0.25;

/// A road like the measured ones: weak below 2 m, strong at 16 m and more.
constexpr SpectrumShape bent{{-1.2, -0.9, -0.5, 0, 0.4, 1.2, 1.5}};

double power(const Autoregression& process, double wave_m) {
    std::complex<double> sum = 1;
    for (std::size_t i = 0; i < process.weights.size(); ++i) {
        sum -=
            process.weights[i] *
            std::polar(1.0, -2 * std::numbers::pi * cell_m / wave_m * static_cast<double>(i + 1));
    }
    return process.increment_variance / std::norm(sum);
}

double middle_m(std::size_t octave) {
    return SpectrumShape::shortest_m * std::exp2(static_cast<double>(octave) + 0.5);
}

/// Changes of the mean from station to station.
std::vector<double> drawn_changes(const SpectrumShape& shape, std::size_t stations) {
    const auto process = autoregression_of(shape, cell_m);
    std::mt19937 random{7};
    std::normal_distribution<double> normal{0, std::sqrt(process.increment_variance)};
    std::vector<double> changes;
    for (std::size_t at = 0; at < stations; ++at) {
        double change = normal(random);
        for (std::size_t i = 0; i < process.weights.size() && i < at; ++i) {
            change += process.weights[i] * changes[at - 1 - i];
        }
        changes.push_back(change);
    }
    return changes;
}

/// Returns the smoother's result for a road whose changes the data determine entirely.
SmoothedRoad seen_under(const RoadPrior& prior, const std::vector<double>& changes) {
    SmoothedRoad road;
    road.perturbed_m.resize(changes.size());
    for (std::size_t at = 0; at < changes.size(); ++at) {
        double increment = changes[at];
        for (std::size_t i = 0; i < prior.change_weights.size() && i < at; ++i) {
            increment -= prior.change_weights[i] * changes[at - 1 - i];
        }
        road.increment_m.push_back({increment, 0});
    }
    return road;
}

/// Runs the rounds of the smoother on a road that the data determine entirely, or not at all.
SpectrumShape found(const std::vector<double>& changes, bool determined) {
    SpectrumShape shape;
    RoadPrior prior;
    prior.increments.assign(changes.size(), {1, 0.3, 0});
    for (int round = 0; round < 12; ++round) {
        auto road = seen_under(prior, changes);
        if (!determined) {
            std::swap(road.increment_m, road.perturbed_m);
        }
        shape = adapted(shape, prior, road, cell_m);
        auto process = autoregression_of(shape, cell_m);
        prior.change_weights = process.weights;
        for (auto& increment : prior.increments) {
            increment.mean *= process.increment_variance;
        }
    }
    return shape;
}

} // namespace

TEST(Autoregression, OfAnEvenSpectrumIsARandomWalk) {
    const auto process = autoregression_of({}, cell_m);
    ASSERT_EQ(process.weights.size(), 12);
    EXPECT_NEAR(process.increment_variance, 1, 0.02); // a sum of 600 lines
    for (const double weight : process.weights) {
        EXPECT_NEAR(weight, 0, 0.02);
    }
}

/// Twelve stations span 3 m; waves longer than 6 m are only approximated.
TEST(Autoregression, HasTheSpectrumThatIsAskedFor) {
    const auto process = autoregression_of(bent, cell_m);
    for (std::size_t octave = 0; octave < SpectrumShape::octaves; ++octave) {
        const double tolerance = middle_m(octave) < 6 ? 0.2 : 0.7;
        EXPECT_NEAR(std::log(power(process, middle_m(octave))), bent.log_level[octave], tolerance)
            << middle_m(octave) << " m";
    }
}

TEST(Autoregression, ScalesWithTheLevel) {
    SpectrumShape higher = bent;
    for (double& level : higher.log_level) {
        level += std::log(5.0);
    }
    const auto one = autoregression_of(bent, cell_m);
    const auto other = autoregression_of(higher, cell_m);
    EXPECT_NEAR(other.increment_variance / one.increment_variance, 5, 1e-9);
    ASSERT_EQ(one.weights.size(), other.weights.size());
    for (std::size_t i = 0; i < one.weights.size(); ++i) {
        EXPECT_NEAR(one.weights[i], other.weights[i], 1e-9);
    }
}

/// An octave of n waves is known to sqrt(2 / n): 0.2 for waves of 16 to 32 m on 2.5 km; and the
/// long waves as well as the autoregression can have them.
TEST(SpectrumShape, OfARoadThatIsKnownIsFound) {
    const auto shape = found(drawn_changes(bent, 10'000), true);
    const auto process = autoregression_of(shape, cell_m);
    const auto drawn = autoregression_of(bent, cell_m);
    for (std::size_t octave = 0; octave < 5; ++octave) {
        const auto relative_to_4_m = [&](const Autoregression& of) {
            return std::log(power(of, middle_m(octave)) / power(of, middle_m(3)));
        };
        EXPECT_NEAR(relative_to_4_m(process), relative_to_4_m(drawn), 0.25)
            << middle_m(octave) << " m";
    }
}

TEST(SpectrumShape, OfARoadOfWhichNothingIsKnownStaysEven) {
    const auto shape = found(drawn_changes({}, 2'000), false);
    for (std::size_t octave = 1; octave < SpectrumShape::octaves; ++octave) {
        EXPECT_NEAR(shape.log_level[octave], shape.log_level[0], 0.4); // a draw's scatter
    }
}

} // namespace macadam::testing
