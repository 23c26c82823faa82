#include "estimator/reference_data.hpp"
#include "estimator/roughness/roughness_mean.hpp"
#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/simulated_car.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace macadam::testing {
namespace {

const Vehicle& audi() {
    return *built_in_vehicle("audi-a6-etron");
}

EstimatorConfig noise_free(Channels channels) {
    EstimatorConfig config;
    config.channels = channels;
    config.filters = false;
    return config;
}

std::function<double(double)> at(double speed_mps) {
    return [=](double) { return speed_mps; };
}

/// The measured road in straight lines at 0.05 m.
std::vector<double> measured_road() {
    const auto road = sorel_even();
    const auto line = along(road.elevation_m, 0.25);
    std::vector<double> fine_m(static_cast<std::size_t>(540 / 0.05));
    for (std::size_t i = 0; i < fine_m.size(); ++i) {
        fine_m[i] = line(0.05 * static_cast<double>(i));
    }
    return fine_m;
}

struct Errors {
    double bias; ///< relative
    double rmse_mm_per_m;
};

/// Estimate against E1926 of the same road on segments of one length, behind a lead-in of 100 m.
Errors
errors_of(const IriRun& run, const std::vector<double>& road_m, double length_m, double segment_m) {
    const IriTrace trace{{run}, {}};
    double sum = 0;
    double square = 0;
    double truth = 0;
    int count = 0;
    for (double from_m = 100; from_m + segment_m < length_m - 40; from_m += segment_m) {
        const auto mean = mean_over(trace, from_m, from_m + segment_m, audi());
        const double expected = true_iri(road_m, 0.05, from_m, from_m + segment_m);
        sum += *mean.hri_mm_per_m - expected;
        square += std::pow(*mean.hri_mm_per_m - expected, 2);
        truth += expected;
        ++count;
    }
    return {sum / truth, std::sqrt(square / count)};
}

double iri(const IriRun& run, const std::vector<float>& track, double from_m, double to_m) {
    IriRun one = run;
    one.centre_mm_per_m = track;
    one.left_mm_per_m.clear();
    one.right_mm_per_m.clear();
    return *mean_over(IriTrace{{one}, {}}, from_m, to_m, audi()).hri_mm_per_m;
}

TEST(Accuracy, OfVerticalVibrationWithoutNoiseIsHalfAPercentOnASyntheticRoad) {
    for (const double kmh : {55.0, 80.0, 105.0}) {
        const auto road_m = iso_road(1500, 1.5, 4);
        const auto line = along(road_m, 0.05);
        const auto ride = drive(audi(), line, line, 1490, at(kmh / 3.6), 1000, 4);
        const auto run =
            estimate_iri(stretch_of(ride, true, false), audi(), noise_free(Channels::vertical));
        const double expected = true_iri(road_m, 0.05, 200, 1400);
        EXPECT_NEAR(iri(run, run.centre_mm_per_m, 200, 1400), expected, 0.005 * expected) << kmh;
    }
}

TEST(Accuracy, OfVerticalVibrationWithoutNoiseIsHalfAPercentOnAMeasuredRoad) {
    const auto road_m = measured_road();
    const auto line = along(road_m, 0.05);
    const auto ride = drive(audi(), line, line, 535, at(80 / 3.6), 1000, 4);
    const auto run =
        estimate_iri(stretch_of(ride, true, false), audi(), noise_free(Channels::vertical));
    const double expected = true_iri(road_m, 0.05, 100, 520);
    EXPECT_NEAR(iri(run, run.centre_mm_per_m, 100, 520), expected, 0.005 * expected);
}

TEST(Accuracy, HoldsWhileTheCarChangesItsSpeed) {
    const auto road_m = iso_road(1500, 1.5, 9);
    const auto line = along(road_m, 0.05);
    const auto speed = [](double at_m) { return 20 + 8 * std::sin(at_m / 90); };
    const auto ride = drive(audi(), line, line, 1490, speed, 1000, 4);
    const auto run =
        estimate_iri(stretch_of(ride, true, false), audi(), noise_free(Channels::vertical));
    const double expected = true_iri(road_m, 0.05, 200, 1400);
    EXPECT_NEAR(iri(run, run.centre_mm_per_m, 200, 1400), expected, 0.005 * expected);
}

TEST(Accuracy, OfBothTracksWithoutNoiseIsHalfAPercentEach) {
    Vehicle car = audi();
    car.imu.height_above_roll_axis_m = 0.4;
    const auto left_m = iso_road(1500, 1.2, 21);
    const auto right_m = iso_road(1500, 1.9, 22);
    const auto ride = drive(car, along(left_m, 0.05), along(right_m, 0.05), 1490, at(22), 1000, 4);
    const auto run =
        estimate_iri(stretch_of(ride, true, true), car, noise_free(Channels::automatic));
    const double left = true_iri(left_m, 0.05, 200, 1400);
    const double right = true_iri(right_m, 0.05, 200, 1400);
    EXPECT_NEAR(iri(run, run.left_mm_per_m, 200, 1400), left, 0.005 * left);
    EXPECT_NEAR(iri(run, run.right_mm_per_m, 200, 1400), right, 0.005 * right);
}

/// On tracks that are each other's mirror image the lateral channel sees everything.
TEST(Accuracy, OfLateralVibrationWithoutNoiseIsHalfAPercentWhereTheTracksAreOpposite) {
    const auto left_m = iso_road(1500, 1.5, 31);
    auto right_m = left_m;
    for (double& z : right_m) {
        z = -z;
    }
    const auto ride =
        drive(audi(), along(left_m, 0.05), along(right_m, 0.05), 1490, at(22), 1000, 4);
    auto config = noise_free(Channels::lateral);
    config.lateral_regression = 1;
    const auto run = estimate_iri(stretch_of(ride, false, true), audi(), config);
    const double expected = true_iri(left_m, 0.05, 200, 1400);
    EXPECT_NEAR(iri(run, run.centre_mm_per_m, 200, 1400), expected, 0.005 * expected);
}

/// The published method's own limits, on a one-axle car: sampling and the 13 Hz filter.
TEST(Accuracy, OfThePublishedSettingsOnAOneAxleCarIsWithinThirtyPercent) {
    const auto road_m = iso_road(3000, 1.0, 5);
    const auto line = along(road_m, 0.05);
    std::printf("one axle, noise 0.05 m/s2, paper's filters, 20 m segments, IRI %.2f mm/m\n",
                true_iri(road_m, 0.05, 100, 2900));
    for (const double kmh : {50.0, 55.0, 80.0, 105.0}) {
        for (const double rate_hz : {50.0, 100.0}) {
            auto ride = drive(audi(), line, line, 2990, at(kmh / 3.6), rate_hz, 20);
            std::mt19937 random{6};
            std::normal_distribution<double> noise{0, 0.05};
            for (double& y : ride.vertical_mps2) {
                y += noise(random);
            }
            const auto run = estimate_iri(stretch_of(ride, true, false), audi(), EstimatorConfig{});
            const auto errors = errors_of(run, road_m, 2990, 20);
            std::printf("  %3.0f km/h %3.0f Hz: bias %+5.1f %%, RMSE %.3f mm/m\n",
                        kmh,
                        rate_hz,
                        100 * errors.bias,
                        errors.rmse_mm_per_m);
            EXPECT_LT(std::abs(errors.bias), 0.3);
        }
    }
}

/// A two-axle car read by the one-axle model: gain 0.72 takes the bias of the wheelbase off, and
/// about 20 % stay on 20 m (what falls between the axles), which is what sd_of_kf_mm_per_m says.
TEST(Accuracy, OfATwoAxleCarIsWhatTheStandardDeviationSays) {
    Vehicle real = audi();
    real.gain = 1;
    const auto road_m = iso_road(3000, 1.0, 8);
    const auto line = along(road_m, 0.05);
    for (const double kmh : {50.0, 80.0, 105.0}) {
        auto ride = drive_on_two_axles(real, line, 2.8, 2990, kmh / 3.6, 50, 20);
        const auto run = estimate_iri(stretch_of(ride, true, false), audi(), EstimatorConfig{});
        const auto errors = errors_of(run, road_m, 2990, 20);
        const auto at_40 = errors_of(run, road_m, 2990, 40);
        const double said =
            sd_of_kf_mm_per_m(true_iri(road_m, 0.05, 100, 2900), 20, kmh / 3.6, false, audi());
        std::printf("two axles, gain 0.72, %3.0f km/h 50 Hz: bias %+5.1f %%, RMSE %.3f (20 m), "
                    "%.3f (40 m), "
                    "said sd %.3f mm/m\n",
                    kmh,
                    100 * errors.bias,
                    errors.rmse_mm_per_m,
                    at_40.rmse_mm_per_m,
                    said);
        EXPECT_LT(errors.rmse_mm_per_m, 1.5 * said);
        EXPECT_GT(errors.rmse_mm_per_m, 0.5 * said);
    }
}

} // namespace
} // namespace macadam::testing
