#include "render/scene/colour_difference.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace macadam {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

struct Lab {
    double l, a, b;
};

constexpr Matrix as_it_is{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Matrix protanopia{{{0.152286, 1.052583, -0.204868},
                             {0.114503, 0.786281, 0.099216},
                             {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix deuteranopia{{{0.367322, 0.860646, -0.227968},
                               {0.280085, 0.672501, 0.047413},
                               {-0.011820, 0.042940, 0.968881}}};
constexpr Matrix tritanopia{{{1.255528, -0.076749, -0.178779},
                             {-0.078411, 0.930809, 0.147602},
                             {0.004733, 0.691367, 0.303900}}};

const Matrix& matrix_of(ColourVision sight) {
    switch (sight) {
    case ColourVision::protanopia:
        return protanopia;
    case ColourVision::deuteranopia:
        return deuteranopia;
    case ColourVision::tritanopia:
        return tritanopia;
    case ColourVision::normal:
        break;
    }
    return as_it_is;
}

Triple times(const Matrix& matrix, const Triple& value) {
    Triple result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            result[i] += matrix[i][j] * value[j];
        }
    }
    return result;
}

Triple linear_rgb(std::uint32_t rgb) {
    const auto channel = [&](unsigned shift) {
        const double c = double(rgb >> shift & 255U) / 255;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); // IEC 61966-2-1
    };
    return {channel(16), channel(8), channel(0)};
}

/// Converts to CIE 1976 L*a*b*, white D65.
Lab lab_of(const Triple& linear) {
    constexpr Matrix xyz_of_srgb{{{0.4124564, 0.3575761, 0.1804375},
                                  {0.2126729, 0.7151522, 0.0721750},
                                  {0.0193339, 0.1191920, 0.9503041}}};
    constexpr Triple white{0.95047, 1, 1.08883};
    auto xyz = times(xyz_of_srgb, linear);
    for (std::size_t i = 0; i < 3; ++i) {
        const double t = xyz[i] / white[i];
        xyz[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
    }
    return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Lab seen(std::uint32_t rgb, ColourVision sight) {
    auto linear = times(matrix_of(sight), linear_rgb(rgb));
    std::ranges::transform(
        linear, linear.begin(), [](double c) { return std::clamp(c, 0.0, 1.0); });
    return lab_of(linear);
}

double cos_deg(double deg) {
    return std::cos(deg * rad_per_deg);
}

double sin_deg(double deg) {
    return std::sin(deg * rad_per_deg);
}

double hue_deg(double a, double b) {
    if (a == 0 && b == 0) {
        return 0;
    }
    const double deg = std::atan2(b, a) * 180 / std::numbers::pi;
    return deg < 0 ? deg + 360 : deg;
}

double mean_hue_deg(double one, double two) {
    if (std::abs(one - two) <= 180) {
        return (one + two) / 2;
    }
    return (one + two + (one + two < 360 ? 360 : -360)) / 2; // eq. 14
}

double weight_of_hue(double mean_deg) {
    return 1 - 0.17 * cos_deg(mean_deg - 30) + 0.24 * cos_deg(2 * mean_deg) +
           0.32 * cos_deg(3 * mean_deg + 6) - 0.20 * cos_deg(4 * mean_deg - 63); // eq. 15
}

/// Increases from 0 for greys to 1 for saturated colours.
double strength(double chroma) {
    return std::sqrt(std::pow(chroma, 7) / (std::pow(chroma, 7) + std::pow(25.0, 7)));
}

/// Computes Sharma, Wu and Dalal's eqs. 2 to 22, with k_L = k_C = k_H = 1.
double ciede2000(const Lab& one, const Lab& two) {
    const double g =
        0.5 * (1 - strength((std::hypot(one.a, one.b) + std::hypot(two.a, two.b)) / 2));
    const double a1 = one.a * (1 + g);
    const double a2 = two.a * (1 + g);
    const double c1 = std::hypot(a1, one.b);
    const double c2 = std::hypot(a2, two.b);
    const double h1 = hue_deg(a1, one.b);
    const double h2 = hue_deg(a2, two.b);
    const bool grey = c1 * c2 == 0; // a grey has no hue
    const double turn_deg = grey ? 0 : std::remainder(h2 - h1, 360.0);
    const double hue_deg = grey ? h1 + h2 : mean_hue_deg(h1, h2);

    const double lightness = (one.l + two.l) / 2 - 50;
    const double chroma = (c1 + c2) / 2;
    const double by_lightness = (two.l - one.l) / (1 + 0.015 * lightness * lightness /
                                                           std::sqrt(20 + lightness * lightness));
    const double by_chroma = (c2 - c1) / (1 + 0.045 * chroma);
    const double by_hue = 2 * std::sqrt(c1 * c2) * sin_deg(turn_deg / 2) /
                          (1 + 0.015 * chroma * weight_of_hue(hue_deg));
    const double blue = (hue_deg - 275) / 25;
    const double rotation = -2 * strength(chroma) * sin_deg(60 * std::exp(-blue * blue));
    return std::sqrt(by_lightness * by_lightness + by_chroma * by_chroma + by_hue * by_hue +
                     rotation * by_chroma * by_hue);
}

double luminance(std::uint32_t rgb) {
    const auto [red, green, blue] = linear_rgb(rgb);
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

} // namespace

std::string_view name_of(ColourVision sight) {
    switch (sight) {
    case ColourVision::protanopia:
        return "protanopia";
    case ColourVision::deuteranopia:
        return "deuteranopia";
    case ColourVision::tritanopia:
        return "tritanopia";
    case ColourVision::normal:
        break;
    }
    return "normal sight";
}

double colour_difference(std::uint32_t a, std::uint32_t b, ColourVision sight) {
    return ciede2000(seen(a, sight), seen(b, sight));
}

NearestColours nearest_colours(std::span<const std::uint32_t> colours) {
    NearestColours nearest{.difference = std::numeric_limits<double>::infinity()};
    for (const auto sight : all_sights) {
        for (std::size_t b = 1; b < colours.size(); ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                const double difference = colour_difference(colours[a], colours[b], sight);
                if (difference < nearest.difference) {
                    nearest = {a, b, sight, difference};
                }
            }
        }
    }
    return nearest;
}

double contrast_ratio(std::uint32_t a, std::uint32_t b) {
    const auto [dark, light] = std::minmax({luminance(a), luminance(b)});
    return (light + 0.05) / (dark + 0.05);
}

} // namespace macadam
