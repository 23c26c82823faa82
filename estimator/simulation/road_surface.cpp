#include "estimator/simulation/road_surface.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/random.hpp"
#include "estimator/simulation/road_features.hpp"
#include "estimator/simulation/road_spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace macadam {

namespace {

using std::numbers::pi;

constexpr double usual_step_m = 0.05;
constexpr double min_length_m = 0.1;
constexpr double max_length_m = 200'000;
constexpr double across_m = 0.25;      // between lines
constexpr int lines_a_side = 5;        // wheels run up to 1.25 m from the middle
constexpr double alike_across_m = 0.4; // of the independent part: exp(-(d / 0.4)^2 / 2)
constexpr double settling_m = 30;      // start-up of the filters
constexpr double level_step_m = 1;     // of the roughness level
constexpr double end_m = 100;          // over which the transition to elevation 0 at an end extends
constexpr double end_slope_m = 5;      // over which the slope at an end is measured

constexpr std::size_t line_count = 2 * lines_a_side + 1;
constexpr std::size_t stream_count = line_count + 1; // the first is common to all lines
constexpr int taps_a_side = 3;
constexpr std::size_t tap_count = 2 * taps_a_side + 1;

using Streams = std::array<double, stream_count>;

void check(const RoadRecipe& recipe, double length_m) {
    const auto refuse = [](const char* what, double value, double low, double high) {
        if (!(value >= low && value <= high)) {
            throw InputError{
                fmt::format("road: {} is {}, expected {} to {}", what, value, low, high)};
        }
    };
    refuse("length in metres", length_m, min_length_m, max_length_m);
    refuse("iri", recipe.iri_mm_per_m, 0.01, 50);
    refuse("waviness", recipe.waviness, 1.2, 3.2);
    refuse("long_wave_ratio", recipe.long_wave_ratio.value_or(1), min_wave_ratio, max_wave_ratio);
    refuse("short_wave_ratio", recipe.short_wave_ratio.value_or(1), min_wave_ratio, max_wave_ratio);
    refuse("level_sd", recipe.level_sd, 0, 1.5);
    refuse("level_length_m", recipe.level_length_m, 5, 10'000);
    refuse("coherency_length_m", recipe.coherency_length_m, 0.1, 100);
    if (recipe.joint_spacing_m != 0) {
        refuse("joint_spacing_m", recipe.joint_spacing_m, 1, 100);
    }
    refuse("joint_step_mm", recipe.joint_step_mm, 0, 50);
    refuse("patches_per_km", recipe.patches_per_km, 0, 200);
    refuse("potholes_per_km", recipe.potholes_per_km, 0, 200);
}

/// Level of roughness with mean 1: the exponential of white noise through two equal low-passes.
class Level {
public:
    Level(const RoadRecipe& recipe, double step_m, std::uint64_t seed)
        : random_{seed}, sd_{recipe.level_sd}, pole_{std::exp(-2 * level_step_m /
                                                              recipe.level_length_m)},
          gain_{std::sqrt((1 - pole_ * pole_) * (1 - pole_ * pole_) * (1 - pole_ * pole_) /
                          (1 + pole_ * pole_))},
          rise_{step_m / level_step_m} {
        for (double at_m = 0; at_m < 5 * recipe.level_length_m; at_m += level_step_m) {
            advance();
        }
        advance();
    }

    double next() {
        part_ += rise_;
        if (part_ >= 1) {
            part_ -= 1;
            advance();
        }
        return from_ + (to_ - from_) * part_;
    }

private:
    void advance() {
        first_ = pole_ * first_ + random_.normal();
        second_ = pole_ * second_ + first_;
        from_ = to_;
        to_ = std::exp(sd_ * gain_ * second_ - sd_ * sd_ / 2);
    }

    Random random_;
    double sd_;
    double pole_;
    double gain_;
    double rise_;
    double first_ = 0;
    double second_ = 0;
    double from_ = 1;
    double to_ = 1;
    double part_ = 0;
};

/// Returns weights over independent neighbours that correlate lines over alike_across_m; their
/// squares sum to 1.
std::array<double, tap_count> taps() {
    std::array<double, tap_count> weight{};
    double square = 0;
    for (std::size_t i = 0; i < tap_count; ++i) {
        const double d = (static_cast<double>(i) - taps_a_side) * across_m / alike_across_m;
        weight[i] = std::exp(-d * d);
        square += weight[i] * weight[i];
    }
    for (double& w : weight) {
        w /= std::sqrt(square);
    }
    return weight;
}

/// Draws white noise of variance 1 for every stream. Its distribution does not matter, since
/// hundreds of draws add up to an elevation.
Streams draw(Random& random, const std::array<double, tap_count>& weight) {
    const double spread = std::sqrt(12.0);
    std::array<double, line_count + tap_count - 1> own{};
    for (double& x : own) {
        x = spread * (random.uniform() - 0.5);
    }
    Streams streams{};
    streams[0] = spread * (random.uniform() - 0.5);
    for (std::size_t i = 0; i < tap_count; ++i) {
        for (std::size_t line = 0; line < line_count; ++line) {
            streams[line + 1] += weight[i] * own[line + i];
        }
    }
    return streams;
}

/// Converts noise to elevations: the road filter in every stream, then the long waves of the common
/// stream and the short waves of the lines' own, whose powers sum to one.
class Shaper {
public:
    Shaper(const RoadFilter& filter, double coherency_length_m) : filter_{filter} {
        const double half_turn = pi * filter.step_m / coherency_length_m;
        const double k = std::sin(half_turn) / std::cos(half_turn);
        pole_ = (1 - k) / (1 + k);
        low_ = k / (1 + k);
        high_ = 1 / (1 + k);
    }

    Streams next(const Streams& noise) {
        Streams now = noise;
        for (std::size_t i = 0; i < stream_count; ++i) {
            integral_[i] = filter_.leak * integral_[i] + now[i];
            now[i] = integral_[i];
        }
        for (std::size_t p = 0; p < filter_.pole.size(); ++p) {
            for (std::size_t i = 0; i < stream_count; ++i) {
                const double in = now[i];
                now[i] = in - filter_.zero[p] * in_[p][i] + filter_.pole[p] * out_[p][i];
                in_[p][i] = in;
                out_[p][i] = now[i];
            }
        }
        return split(now);
    }

private:
    Streams split(const Streams& shaped) {
        Streams lines{};
        common_ = pole_ * common_ + low_ * (shaped[0] + shaped_[0]);
        for (std::size_t i = 1; i < stream_count; ++i) {
            own_[i] = pole_ * own_[i] + high_ * (shaped[i] - shaped_[i]);
            lines[i] = common_ + own_[i];
        }
        shaped_ = shaped;
        return lines;
    }

    RoadFilter filter_;
    double pole_;
    double low_;
    double high_;
    double common_ = 0;
    Streams own_{};
    Streams shaped_{};
    Streams integral_{};
    std::array<Streams, RoadFilter::pair_count> in_{};
    std::array<Streams, RoadFilter::pair_count> out_{};
};

RoadSurface flat_surface(double length_m) {
    const double steps = std::max(2.0, std::floor(length_m / usual_step_m + 0.5));
    RoadSurface surface;
    surface.step_m = length_m / steps;
    for (int i = -lines_a_side; i <= lines_a_side; ++i) {
        surface.line_lateral_m.push_back(static_cast<float>(i * across_m));
        surface.elevation_m.emplace_back(static_cast<std::size_t>(steps) + 1);
    }
    return surface;
}

RoadSurface random_surface(const RoadRecipe& recipe, double length_m, std::uint64_t seed) {
    RoadSurface surface = flat_surface(length_m);
    const RoadFilter filter = road_filter(recipe, surface.step_m);
    const double sd_m = noise_sd_m(recipe, filter);
    const auto weight = taps();
    Shaper shaper{filter, recipe.coherency_length_m};
    Level level{recipe, surface.step_m, seed_of({seed, 4})};
    Random random{seed_of({seed, 5})};

    const auto settling = static_cast<std::ptrdiff_t>(settling_m / surface.step_m);
    const auto stations = static_cast<std::ptrdiff_t>(surface.elevation_m.front().size());
    for (std::ptrdiff_t at = -settling; at < stations; ++at) {
        Streams noise = draw(random, weight);
        const double size_m = sd_m * level.next();
        for (double& x : noise) {
            x *= size_m;
        }
        const Streams lines = shaper.next(noise);
        for (std::size_t line = 0; at >= 0 && line < line_count; ++line) {
            surface.elevation_m[line][static_cast<std::size_t>(at)] =
                static_cast<float>(lines[line + 1]);
        }
    }
    return surface;
}

/// Returns a smooth transition from an elevation and a slope (over its length) to 0 without slope;
/// t from 0 to 1.
double way_to_zero(double elevation, double slope, double t) {
    const double rest = 1 - t;
    return rest * rest * (elevation * (1 + 2 * t) + slope * t);
}

/// Subtracts smooth transitions from the line's ends to 0: waves shorter than the lane or 100 m
/// remain.
std::vector<float> with_ends_at_zero(std::vector<float> line, double step_m) {
    const std::size_t last = line.size() - 1;
    const double length_m = static_cast<double>(last) * step_m;
    const auto at = [&](std::size_t i) { return static_cast<double>(line[i]); };
    const auto slope_steps = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::min(length_m / 4, end_slope_m) / step_m));
    const auto way_steps = std::min(last, static_cast<std::size_t>(std::floor(end_m / step_m)));
    const double ways = static_cast<double>(way_steps) / static_cast<double>(slope_steps);
    const double begin_m = at(0);
    const double end_elevation_m = at(last);
    const double begin_rise_m = (at(slope_steps) - begin_m) * ways;
    const double end_rise_m = (at(last - slope_steps) - end_elevation_m) * ways;
    for (std::size_t i = 0; i <= way_steps; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(way_steps);
        line[i] = static_cast<float>(at(i) - way_to_zero(begin_m, begin_rise_m, t));
        line[last - i] =
            static_cast<float>(at(last - i) - way_to_zero(end_elevation_m, end_rise_m, t));
    }
    return line;
}

struct Cubic {
    std::array<std::size_t, 4> line;
    std::array<double, 4> weight;
};

/// Returns the Catmull-Rom cubic through evenly spaced lines.
Cubic cubic_across(const RoadSurface& surface, double lateral_m) {
    const auto& lines = surface.line_lateral_m;
    const auto last = static_cast<double>(lines.size() - 1);
    const auto first_m = static_cast<double>(lines.front());
    const double spacing_m = (static_cast<double>(lines.back()) - first_m) / last;
    const double place = std::clamp((lateral_m - first_m) / spacing_m, 0.0, last);
    const double base = std::min(std::floor(place), last - 1);
    const double t = place - base;
    const auto line = [&](double i) {
        return static_cast<std::size_t>(std::clamp(base + i, 0.0, last));
    };
    return {{line(-1), line(0), line(1), line(2)},
            {t * (-0.5 + t * (1 - 0.5 * t)),
             1 + t * t * (-2.5 + 1.5 * t),
             t * (0.5 + t * (2 - 1.5 * t)),
             t * t * (-0.5 + 0.5 * t)}};
}

std::vector<double> path(const RoadSurface& surface, double lateral_m) {
    const Cubic across = cubic_across(surface, lateral_m);
    std::vector<double> path_m(surface.elevation_m.front().size());
    for (std::size_t i = 0; i < path_m.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            path_m[i] +=
                across.weight[k] * static_cast<double>(surface.elevation_m[across.line[k]][i]);
        }
    }
    return path_m;
}

} // namespace

double RoadSurface::length_m() const {
    return step_m * static_cast<double>(elevation_m.front().size() - 1);
}

RoadSurface make_surface(const RoadRecipe& recipe, double length_m, std::uint64_t seed) {
    check(recipe, length_m);
    RoadSurface surface = random_surface(recipe, length_m, seed);
    for (auto& line : surface.elevation_m) {
        line = with_ends_at_zero(std::move(line), surface.step_m);
    }
    return with_features(std::move(surface), recipe, seed);
}

double elevation_m(const RoadSurface& surface, double station_m, double lateral_m) {
    const Cubic across = cubic_across(surface, lateral_m);
    const auto last = static_cast<double>(surface.elevation_m.front().size() - 1);
    const double place = std::clamp(station_m / surface.step_m, 0.0, last);
    const double base = std::min(std::floor(place), last - 1);
    const double t = place - base;
    const auto i = static_cast<std::size_t>(base);
    double sum_m = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto& line = surface.elevation_m[across.line[k]];
        const auto here_m = static_cast<double>(line[i]);
        sum_m += across.weight[k] * (here_m + t * (static_cast<double>(line[i + 1]) - here_m));
    }
    return sum_m;
}

WheelPaths wheel_paths(const RoadSurface& surface) {
    return {surface.step_m, path(surface, wheel_path_m), path(surface, -wheel_path_m)};
}

} // namespace macadam
