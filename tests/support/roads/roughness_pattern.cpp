#include "roughness_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

constexpr double per_m = 10;

double value_at(const std::vector<double>& pattern, double station_m) {
    const double at = std::clamp(station_m * per_m, 0.0, static_cast<double>(pattern.size()) - 2);
    const auto i = static_cast<std::size_t>(at);
    return std::lerp(pattern[i], pattern[i + 1], at - static_cast<double>(i));
}

} // namespace

std::vector<double> roughness_pattern(double length_m, std::uint64_t seed) {
    std::mt19937_64 random{seed};
    std::normal_distribution<double> normal;
    constexpr int half = 10; // 2 m of white noise under a mean: little is left below 4 m
    std::vector<double> white(static_cast<std::size_t>(length_m * per_m) + 2 * half);
    std::ranges::generate(white, [&] { return normal(random); });
    std::vector<double> pattern;
    for (std::size_t i = half; i + half < white.size(); ++i) {
        double sum = 0;
        for (std::size_t k = i - half; k <= i + half; ++k) {
            sum += white[k];
        }
        pattern.push_back(std::exp(0.5 * sum / std::sqrt(2.0 * half + 1) - 0.125));
    }
    return pattern;
}

RoughnessTrace read_pattern(const std::vector<double>& pattern, const Reading& reading) {
    std::mt19937_64 random{reading.seed};
    std::normal_distribution<double> normal;
    RoughnessTrace trace{.chunk = {1, true, 0},
                         .drive = 0,
                         .first_m = static_cast<std::int32_t>(reading.from_m),
                         .iri = {},
                         .left = {},
                         .place_sd_mm = static_cast<std::int32_t>(1000 * reading.place_sd_m)};
    for (double station_m = reading.from_m; station_m < reading.to_m; ++station_m) {
        const double lag_m = reading.lag_m ? reading.lag_m(station_m + 0.5) : 0;
        double sum = 0;
        for (int part = 0; part < per_m; ++part) {
            sum += value_at(pattern, station_m - lag_m + (part + 0.5) / per_m) / per_m;
        }
        trace.iri.push_back(code_of(reading.gain * sum * std::exp(reading.noise * normal(random))));
    }
    return trace;
}

} // namespace macadam::testing
