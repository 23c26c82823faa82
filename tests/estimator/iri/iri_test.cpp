#include "estimator/iri/iri.hpp"

#include "estimator/common/error.hpp"
#include "estimator/reference_data.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

namespace macadam::testing {
namespace {

using std::numbers::pi;

std::vector<double> sampled(double length_m, double step_m, auto elevation_m) {
    std::vector<double> profile_m(static_cast<std::size_t>(length_m / step_m + 0.5) + 1);
    for (std::size_t i = 0; i < profile_m.size(); ++i) {
        profile_m[i] = elevation_m(static_cast<double>(i) * step_m);
    }
    return profile_m;
}

double mean(std::span<const float> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> rough_road(std::size_t count) {
    std::mt19937 random{7};
    std::normal_distribution<double> step_m{0, 0.001};
    std::vector<double> profile_m(count);
    double height_m = 0;
    for (double& z : profile_m) {
        z = height_m += step_m(random);
    }
    return profile_m;
}

std::string refusal(const std::vector<double>& profile_m, double step_m) {
    try {
        iri_mm_per_m(profile_m, step_m);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

/// Amplitude 1 mm: (4 / wavelength) |G| sinc(0.25 / wavelength), G of the golden car from the table
/// of tests/data by its closed form; after 200 m nothing is left of the start.
TEST(Iri, OfALongSineMeetsTheFrequencyResponse) {
    const struct {
        double wavelength_m, iri, tolerance;
    } cases[] = {{1, 0.9835, 0.005},
                 {1.5, 1.9945, 0.003},
                 {2, 2.9889, 0.003},
                 {2.4, 2.7241, 0.003},
                 {3, 1.9156, 0.003},
                 {5, 0.9319, 0.003},
                 {10, 0.50336, 0.003},
                 {15, 0.40710, 0.003},
                 {20, 0.24674, 0.003},
                 {30, 0.060635, 0.003},
                 {50, 0.010927, 0.003},
                 {100, 0.001264, 0.003}};
    for (const auto& [wavelength_m, iri, tolerance] : cases) {
        const double whole_m =
            200 + 600; // a multiple of every wavelength but 1.5 and 2.4's fractions
        const auto profile_m = sampled(whole_m + 1, 0.05, [=](double x) {
            return 0.001 * std::sin(2 * pi * x / wavelength_m);
        });
        const auto stroke = rectified_stroke_mm_per_m(profile_m, 0.05);
        const auto settled = std::span{stroke}.subspan(4000, 12000);
        EXPECT_NEAR(mean(settled), iri, tolerance * iri) << wavelength_m << " m";
    }
}

TEST(Iri, KnowsNeitherDatumNorGradeNorSide) {
    const auto road_m = rough_road(4000);
    const double iri = iri_mm_per_m(road_m, 0.1);
    auto raised_m = road_m;
    auto climbing_m = road_m;
    auto mirrored_m = road_m;
    auto doubled_m = road_m;
    for (std::size_t i = 0; i < road_m.size(); ++i) {
        raised_m[i] += 1000;
        climbing_m[i] += 0.1 * 0.1 * static_cast<double>(i);
        mirrored_m[i] *= -1;
        doubled_m[i] *= 2;
    }
    // Elevations near 1000 m are held to 1e-13 m: 1e-10 of a slope over 0.3 m.
    EXPECT_NEAR(iri_mm_per_m(raised_m, 0.1), iri, 1e-9 * iri);
    EXPECT_NEAR(iri_mm_per_m(climbing_m, 0.1), iri, 1e-9 * iri);
    EXPECT_NEAR(iri_mm_per_m(mirrored_m, 0.1), iri, 1e-9 * iri);
    EXPECT_NEAR(iri_mm_per_m(doubled_m, 0.1), 2 * iri, 1e-9 * iri);
}

TEST(Iri, OfAPlaneIsZeroWhateverItsGrade) {
    for (const double grade : {0.0, 0.1, -0.1}) {
        const auto plane_m = sampled(200, 0.25, [=](double x) { return 5 + grade * x; });
        EXPECT_NEAR(iri_mm_per_m(plane_m, 0.25), 0, 1e-9) << grade;
    }
}

/// Accumulated stroke over 30 m, from an independent program; 1e-4 mm is its last digit and ours.
TEST(Iri, OfATrianglePulseMeetsTheReferenceAtEveryStep) {
    const auto pulse_m = [](double x) { return 0.001 * std::max(0.0, std::min(x - 1, 5 - x)); };
    const struct {
        double step_m, travel_mm;
    } cases[] = {{0.25, 6.14864}, {0.1, 6.13173}, {0.05, 6.14090}};
    for (const auto& [step_m, travel_mm] : cases) {
        const auto count = static_cast<std::size_t>(30 / step_m + 0.5);
        const auto stroke = rectified_stroke_mm_per_m(sampled(40, step_m, pulse_m), step_m);
        EXPECT_NEAR(mean(std::span{stroke}.first(count)) * 30, travel_mm, 1e-4) << step_m;
    }
}

TEST(Iri, OfAMeasuredRoadMeetsThePublishedProgram) {
    const auto road = starting_at(sorel_even(), 478.5);
    const auto stroke = rectified_stroke_mm_per_m(road.elevation_m, 0.25);
    const auto table = read_table("iri_reference/sorel_profile1_start478.5.csv", 1);
    for (std::size_t segment = 0; segment < 27; ++segment) {
        const auto& row = table[segment];
        const double iri = mean(std::span{stroke}.subspan(80 * segment, 80));
        // The publication starts with the slope over 0.5 s (11.11 m) instead of 11 m.
        const double tolerance = segment == 0 ? 3e-4 : segment == 1 ? 1e-4 : 1e-5;
        EXPECT_NEAR(iri, row[4], tolerance * row[4] + 1e-6) << row[2];
        EXPECT_NEAR(iri, row[7], 2e-6) << row[2];
    }
}

TEST(Iri, OfSegmentsIsThatOfTheWhole) {
    const auto stroke = rectified_stroke_mm_per_m(rough_road(4003), 0.1);
    double sum = 0;
    for (std::size_t from = 0; from < 4000; from += 200) {
        sum += mean(std::span{stroke}.subspan(from, 200));
    }
    EXPECT_NEAR(sum / 20, mean(std::span{stroke}.first(4000)), 1e-9);
}

TEST(Iri, OfAPieceWithALeadInIsThatOfTheWholeRoad) {
    const auto road_m = rough_road(12000);
    const auto whole = rectified_stroke_mm_per_m(road_m, 0.1);
    const auto piece = rectified_stroke_mm_per_m(std::span{road_m}.subspan(5000), 0.1);
    const double expected = mean(std::span{whole}.subspan(6000, 200));
    // 100 m lie in front: 1e-5 of the start is left (IRI's slowest pole falls by e in 8.6 m).
    EXPECT_NEAR(mean(std::span{piece}.subspan(1000, 200)), expected, 1e-5 * expected);
}

/// White slope of one-sided density 6.317e-6 m (class A, waviness 2): 2.173 by Parseval over the
/// golden car's response with the 250 mm mean.
TEST(Iri, OfIsoClassAIsItsClosedForm) {
    const double step_m = 0.05;
    double sum = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        std::mt19937 random{seed};
        std::normal_distribution<double> slope{0, std::sqrt(6.317e-6 / 2 / step_m)};
        std::vector<double> road_m(20000 * 20);
        double height_m = 0;
        for (double& z : road_m) {
            z = height_m += slope(random) * step_m;
        }
        const double iri = iri_mm_per_m(road_m, step_m);
        EXPECT_NEAR(iri, 2.173, 0.0106 * 2.173); // 20 km scatter by 0.26 %; four of that
        sum += iri;
    }
    EXPECT_NEAR(sum / 10, 2.173, 0.005 * 2.173);
}

/// 250 mm of 0.1 m are two and a half steps: three, as the standard's rounding has it, however the
/// step was come by.
TEST(Iri, TakesThreeStepsOfATenthForTheTyre) {
    EXPECT_EQ(envelope_steps(0.1), 3U);
    EXPECT_EQ(envelope_steps(0.1 + 1e-10), 3U);
    EXPECT_EQ(envelope_steps((1234.5 - 0.1) / 12344), 3U);
    EXPECT_EQ(envelope_steps(0.05), 5U);
    EXPECT_EQ(envelope_steps(0.063063), 4U);
    EXPECT_EQ(envelope_steps(0.0762), 3U);
    EXPECT_EQ(envelope_steps(0.3), 1U);
}

TEST(Iri, OfAProfileThatComesPointByPointIsThatOfTheWhole) {
    const auto road_m = rough_road(20'000);
    const auto whole = rectified_stroke_mm_per_m(road_m, 0.05);
    RectifiedStroke stroke{0.05};
    std::vector<float> values;
    const auto drain = [&] {
        while (const auto value = stroke.next()) {
            values.push_back(static_cast<float>(*value));
        }
    };
    for (std::size_t i = 0; i < road_m.size(); ++i) {
        stroke.push(road_m[i]);
        if (i % 777 == 0) {
            drain();
        }
    }
    stroke.finish();
    drain();
    EXPECT_EQ(values, whole);
}

TEST(Iri, OfTheSignedStrokeIsItsMagnitude) {
    std::vector<double> elevation_m, mirrored_m;
    for (int i = 0; i < 2000; ++i) {
        elevation_m.push_back(0.01 * std::sin(0.13 * i) + 0.004 * std::sin(0.41 * i));
        mirrored_m.push_back(-elevation_m.back());
    }
    const auto stroke = suspension_stroke_mm_per_m(elevation_m, 0.1);
    const auto mirrored = suspension_stroke_mm_per_m(mirrored_m, 0.1);
    const auto rectified = rectified_stroke_mm_per_m(elevation_m, 0.1);
    ASSERT_EQ(stroke.size(), rectified.size());
    int compressed = 0;
    for (std::size_t i = 0; i < stroke.size(); ++i) {
        EXPECT_FLOAT_EQ(static_cast<float>(std::abs(stroke[i])), rectified[i]);
        EXPECT_DOUBLE_EQ(mirrored[i], -stroke[i]);
        compressed += stroke[i] > 0 ? 1 : 0;
    }
    EXPECT_NEAR(compressed, 1000, 50); // a vibration has both signs alike
}

TEST(Iri, WithoutEnvelopeKeepsTheShortWaves) {
    const auto road_m = sampled(800, 0.05, [](double x) { return 0.001 * std::sin(2 * pi * x); });
    // Closed form without the 250 mm mean: 1.0923 for 1 mm at 1 m; 20 samples a
    // wave and the start take up to 0.7 %; the mean would take 10 %.
    EXPECT_NEAR(iri_mm_per_m(road_m, 0.05, false), 1.0923, 0.01 * 1.0923);
}

TEST(Iri, SaysWhatIsWrongAndWhatItExpected) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(refusal({1}, 0.1), "profile has 1 points, expected at least 2");
    EXPECT_EQ(refusal({1, 1}, 0.5), "profile step is 0.5 m, expected 0 to 0.3");
    EXPECT_EQ(refusal({1, 1}, 0), "profile step is 0 m, expected 0 to 0.3");
    EXPECT_EQ(refusal({1, nan}, 0.1), "profile elevation 1 is 'nan', expected a finite number");
}

} // namespace
} // namespace macadam::testing
