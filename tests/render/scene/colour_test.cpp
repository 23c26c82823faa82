#include "render/scene/colour.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/print_ramp.hpp"
#include "render/scene/colour_difference.hpp"
#include "render/scene/style_check.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

Triple times(const Matrix& matrix, const Triple& value) {
    Triple result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            result[i] += matrix[i][j] * value[j];
        }
    }
    return result;
}

Triple linear(std::uint32_t rgb) {
    Triple value{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double c = double(rgb >> (16 - 8 * i) & 255U) / 255;
        value[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); // IEC 61966-2-1
    }
    return value;
}

double contrast(std::uint32_t a, std::uint32_t b) { // WCAG 2.1
    const auto luminance = [](std::uint32_t rgb) {
        const auto [red, green, blue] = linear(rgb);
        return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    };
    const auto [dark, light] = std::minmax({luminance(a), luminance(b)});
    return (light + 0.05) / (dark + 0.05);
}

Triple lab_of(const Triple& linear_rgb) {
    const Matrix xyz_of_srgb{{{0.4124564, 0.3575761, 0.1804375},
                              {0.2126729, 0.7151522, 0.0721750},
                              {0.0193339, 0.1191920, 0.9503041}}};
    const Triple white{0.95047, 1, 1.08883}; // D65
    auto xyz = times(xyz_of_srgb, linear_rgb);
    for (std::size_t i = 0; i < 3; ++i) {
        const double t = xyz[i] / white[i];
        xyz[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
    }
    return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

double degrees(double radians) {
    const double deg = radians * 180 / std::numbers::pi;
    return deg < 0 ? deg + 360 : deg;
}

double cos_deg(double deg) {
    return std::cos(deg * std::numbers::pi / 180);
}

/// G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 color-difference formula", Color Research and
/// Application 30 (2005), pp. 21-30.
double ciede2000(const Triple& one, const Triple& two) {
    const auto pow7 = [](double x) { return std::pow(x, 7); };
    const double mean_c = (std::hypot(one[1], one[2]) + std::hypot(two[1], two[2])) / 2;
    const double g = 0.5 * (1 - std::sqrt(pow7(mean_c) / (pow7(mean_c) + pow7(25))));
    const double a1 = one[1] * (1 + g);
    const double a2 = two[1] * (1 + g);
    const double c1 = std::hypot(a1, one[2]);
    const double c2 = std::hypot(a2, two[2]);
    const double h1 = c1 == 0 ? 0 : degrees(std::atan2(one[2], a1));
    const double h2 = c2 == 0 ? 0 : degrees(std::atan2(two[2], a2));

    const bool grey = c1 * c2 == 0;
    const double dh = grey ? 0 : std::remainder(h2 - h1, 360.0);
    const double d_hue = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2 * std::numbers::pi / 180);
    double mean_h = grey ? h1 + h2 : (h1 + h2) / 2;
    if (!grey && std::abs(h1 - h2) > 180) {
        mean_h += h1 + h2 < 360 ? 180 : -180;
    }
    const double l = (one[0] + two[0]) / 2;
    const double c = (c1 + c2) / 2;
    const double t = 1 - 0.17 * cos_deg(mean_h - 30) + 0.24 * cos_deg(2 * mean_h) +
                     0.32 * cos_deg(3 * mean_h + 6) - 0.20 * cos_deg(4 * mean_h - 63);
    const double s_l = 1 + 0.015 * (l - 50) * (l - 50) / std::sqrt(20 + (l - 50) * (l - 50));
    const double s_c = 1 + 0.045 * c;
    const double s_h = 1 + 0.015 * c * t;
    const double turn = 30 * std::exp(-std::pow((mean_h - 275) / 25, 2));
    const double r_t = -2 * std::sqrt(pow7(c) / (pow7(c) + pow7(25))) *
                       std::sin(2 * turn * std::numbers::pi / 180);
    const double in_l = (two[0] - one[0]) / s_l;
    const double in_c = (c2 - c1) / s_c;
    const double in_h = d_hue / s_h;
    return std::sqrt(in_l * in_l + in_c * in_c + in_h * in_h + r_t * in_c * in_h);
}

/// G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A physiologically-based model for simulation
/// of color vision deficiency", IEEE TVCG 15 (2009), pp. 1291-1298; severity 1, on linear RGB.
const std::array<Matrix, 3> deficiencies{Matrix{{{0.152286, 1.052583, -0.204868}, // protanopia
                                                 {0.114503, 0.786281, 0.099216},
                                                 {-0.003882, -0.048116, 1.051998}}},
                                         Matrix{{{0.367322, 0.860646, -0.227968}, // deuteranopia
                                                 {0.280085, 0.672501, 0.047413},
                                                 {-0.011820, 0.042940, 0.968881}}},
                                         Matrix{{{1.255528, -0.076749, -0.178779}, // tritanopia
                                                 {-0.078411, 0.930809, 0.147602},
                                                 {0.004733, 0.691367, 0.303900}}}};

Triple seen(const Matrix& deficiency, std::uint32_t rgb) {
    auto value = times(deficiency, linear(rgb));
    std::ranges::transform(value, value.begin(), [](double c) { return std::clamp(c, 0.0, 1.0); });
    return lab_of(value);
}

double min_difference(const Matrix& deficiency, const std::vector<std::uint32_t>& colours) {
    double least = 1000;
    for (std::size_t i = 0; i < colours.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            least = std::min(least,
                             ciede2000(seen(deficiency, colours[i]), seen(deficiency, colours[j])));
        }
    }
    return least;
}

constexpr std::array themes{MapStyle::Theme::light, MapStyle::Theme::dark, MapStyle::Theme::print};

} // namespace

TEST(Colour, DifferenceMeetsThePublishedPairs) {
    // Sharma, Wu and Dalal, table 1, pairs 1, 17 and 25.
    EXPECT_NEAR(ciede2000({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 5e-5);
    EXPECT_NEAR(ciede2000({50, 2.5, 0}, {73, 25, -18}), 27.1492, 5e-5);
    EXPECT_NEAR(
        ciede2000({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}), 1.2644, 5e-5);
}

TEST(Colour, ClassesStayApartForEveryKindOfColourBlindness) {
    ASSERT_FALSE(class_tables().empty());
    for (const auto& ramp : colour_ramps()) {
        for (const auto& table : class_tables()) {
            for (const auto& deficiency : deficiencies) {
                EXPECT_GE(min_difference(deficiency, ramp_colours(ramp.name, table.classes.size())),
                          10)
                    << ramp.name << ' ' << table.name;
            }
        }
    }
}

TEST(Colour, ClassesInPrintStayApartInShadesOfGreyAndForEverySight) {
    const MapStyle style{.own_ramp = {print_ramp.begin(), print_ramp.end()}};
    for (const auto& table : class_tables()) {
        const auto colours = class_colours(style, table.classes.size());
        ASSERT_GE(colours.size(), 3U);
        for (std::size_t i = 1; i < colours.size(); ++i) {
            EXPECT_GT(lab_of(linear(colours[i - 1]))[0] - lab_of(linear(colours[i]))[0], 10)
                << table.name << ' ' << i; // lightness of 100; 10 is told apart side by side
        }
        for (const auto& deficiency : deficiencies) {
            EXPECT_GE(min_difference(deficiency, colours), 10) << table.name;
        }
    }
}

TEST(Colour, GreyOfFewPassesIsTakenForNoClass) {
    for (const auto theme : themes) {
        const auto grey = palette(theme).few_passes;
        EXPECT_GE(contrast(grey, palette(theme).casing), 3);
        for (const auto& ramp : colour_ramps()) {
            for (const auto& table : class_tables()) {
                for (const auto rgb : ramp_colours(ramp.name, table.classes.size())) {
                    for (const auto& deficiency : deficiencies) {
                        EXPECT_GE(min_difference(deficiency, {grey, rgb}), 10)
                            << ramp.name << ' ' << std::hex << rgb;
                    }
                }
            }
        }
    }
}

TEST(Colour, DifferenceIsThatOfTheReferenceForEverySight) {
    std::mt19937 random{1};
    for (int i = 0; i < 300; ++i) {
        const std::uint32_t a = random() & 0xFFFFFFU;
        const std::uint32_t b = i % 3 == 0 ? a ^ (random() & 0x0F0F0FU) : random() & 0xFFFFFFU;
        for (std::size_t d = 0; d < deficiencies.size(); ++d) {
            EXPECT_NEAR(colour_difference(a, b, all_sights[d + 1]),
                        ciede2000(seen(deficiencies[d], a), seen(deficiencies[d], b)),
                        1e-9);
        }
        EXPECT_NEAR(colour_difference(a, b, ColourVision::normal),
                    ciede2000(lab_of(linear(a)), lab_of(linear(b))),
                    1e-9);
        EXPECT_NEAR(contrast_ratio(a, b), contrast(a, b), 1e-12);
    }
    EXPECT_EQ(colour_difference(0x808080, 0x808080, ColourVision::tritanopia), 0);
}

TEST(Colour, ShippedLooksNeedNoWarning) {
    ASSERT_FALSE(class_tables().empty());
    for (const auto theme : themes) {
        for (const auto& ramp : colour_ramps()) {
            for (const auto& table : class_tables()) {
                EXPECT_THAT(style_warnings({.theme = theme, .ramp = std::string{ramp.name}}, table),
                            ::testing::IsEmpty());
            }
        }
    }
}

TEST(Colour, WarnsOfATrafficLight) {
    MapStyle style;
    style.own_ramp = {0x1a9641, 0xa6d96a, 0xffffbf, 0xfdae61, 0xd7191c};
    EXPECT_THAT(style_warnings(style, *class_table("five")),
                ::testing::ElementsAre(
                    "the colours of 'good' (#a6d96a) and 'poor' (#fdae61) differ by 2.0 CIEDE2000 "
                    "with deuteranopia, expected 10 or more"));
}

TEST(Colour, WarnsOfACasingThatDoesNotShow) {
    MapStyle style;
    style.colours.casing = 0xe0e0e0;
    style.colours.ground = 0xffffff;
    EXPECT_THAT(style_warnings(style, *class_table("fhwa")),
                ::testing::ElementsAre("the casing (#e0e0e0) has a contrast of 1.3 to the ground "
                                       "(#ffffff), expected 3 or more"));
}

TEST(Colour, OfAStyleComesBeforeThatOfTheThemeAndTheRamp) {
    MapStyle style;
    style.colours.ink = 0x123456;
    style.own_ramp = {0x000000, 0x808080};
    EXPECT_EQ(palette(style).ink, 0x123456U);
    EXPECT_EQ(palette(style).page, palette(MapStyle::Theme::light).page);
    EXPECT_THAT(class_colours(style, 3), ::testing::ElementsAre(0x000000, 0x404040, 0x808080));
}

TEST(Colour, CasingStandsOutFromTheGround) {
    for (const auto theme : themes) {
        EXPECT_GE(contrast(palette(theme).casing, palette(theme).ground), 3);
    }
}

TEST(Colour, EveryClassStandsOutFromTheGroundOrFromItsCasing) {
    for (const auto theme : themes) {
        for (const auto* ramp : {"rdylbu", "cividis", "viridis"}) {
            const auto classes = ramp_colours(ramp, 5);
            ASSERT_EQ(classes.size(), 5U);
            for (const auto rgb : classes) {
                const auto colours = palette(theme);
                EXPECT_GE(std::max(contrast(rgb, colours.ground), contrast(rgb, colours.casing)), 3)
                    << ramp << ' ' << std::hex << rgb;
            }
        }
    }
}

TEST(Colour, TextCanBeReadOnItsPage) {
    for (const auto theme : themes) {
        EXPECT_GE(contrast(palette(theme).quiet_ink, palette(theme).page), 4.5); // WCAG 2.1, AA
    }
}

TEST(Colour, RampGoesFromBlueToRedByDefault) {
    EXPECT_THAT(ramp_colours("rdylbu", 5),
                ::testing::ElementsAre(0x2c7bb6, 0xabd9e9, 0xffffbf, 0xfdae61, 0xd7191c));
}

TEST(Colour, AnyNumberOfClassesIsSpreadOverTheWholeRamp) {
    const auto colours = ramp_colours("viridis", 9);
    ASSERT_EQ(colours.size(), 9U);
    EXPECT_EQ(colours.front(), 0x440154U);
    EXPECT_EQ(colours[4], 0x21918cU);
    EXPECT_EQ(colours.back(), 0xfde725U);
}

TEST(Colour, UnknownRampIsRefused) {
    EXPECT_THAT([] { ramp_colours("rainbow", 3); },
                ::testing::ThrowsMessage<InputError>(
                    "unknown colour ramp 'rainbow', expected one of rdylbu, cividis, viridis"));
}

} // namespace macadam::testing
