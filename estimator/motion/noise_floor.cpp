#include "estimator/motion/noise_floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace macadam {
namespace {

constexpr std::array second_difference{1.0, -2.0, 1.0};
constexpr std::array fourth_difference{1.0, -4.0, 6.0, -4.0, 1.0};

/// Power of the road in fourth differences over that in second ones, both relative to white noise:
/// 0.2 at 10 Hz and 0.6 at 15 Hz of 50, between which wheels hop.
constexpr double road_share = 0.5;

/// Estimates the white noise that has these differences: standard deviation of a sample. The median
/// is used, so that bumps have no effect.
double noise_of_differences(const std::vector<double>& values, std::span<const double> weights) {
    constexpr double sd_over_mad = 1.4826; // normal distribution
    double sum_of_squares = 0;
    for (const double weight : weights) {
        sum_of_squares += weight * weight;
    }
    std::vector<double> differences;
    for (std::size_t i = 0; i + weights.size() <= values.size(); ++i) {
        double difference = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            difference += weights[k] * values[i + k];
        }
        differences.push_back(std::abs(difference));
    }
    if (differences.empty()) {
        return 0;
    }
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::ranges::nth_element(differences, middle);
    return sd_over_mad * *middle / std::sqrt(sum_of_squares);
}

} // namespace

double noise_floor(const std::vector<double>& values) {
    return noise_of_differences(values, fourth_difference);
}

double noise_beside_road(const std::vector<double>& values) {
    const double fourth = noise_of_differences(values, fourth_difference);
    const double second = noise_of_differences(values, second_difference);
    const double variance = (fourth * fourth - road_share * second * second) / (1 - road_share);
    return std::sqrt(std::max(variance, 0.0));
}

} // namespace macadam
