// The elevations that the smoother leaves, held beside the road that was driven.

#include "driven_road.hpp"
#include "estimator/iri/iri.hpp"
#include "estimator/motion/butterworth.hpp"
#include "estimator/smoother/smoothed_iri.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace macadam::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double step_m = 0.25;
constexpr double keep_off_m = 200; // where the drive and the filters set in

Vehicle car() {
    return two_axle_car({.wheelbase_m = 2.7, .cg_to_front_m = 1.2}, 0.3);
}

DriveRecipe drive_of(double length_m, double speed_kmh) {
    return {.road = {.iri_mm_per_m = 2},
            .car = linear_car_of(car()),
            .length_m = length_m,
            .speed_kmh = speed_kmh};
}

IriRun run_over(const Stretch& stretch, const PieceConfig& pieces = {}) {
    EstimatorConfig config;
    config.method = Method::smoother;
    config.profile = true;
    return smoothed_iri(stretch, {.vehicle = car()}, config, pieces);
}

/// Stations of the truth that the estimate has, the tyre's 250 mm taken as one.
std::vector<double>
true_at(const std::vector<double>& road_m, double road_step_m, const EstimatedProfile& profile) {
    const auto reach = std::lround(step_m / 2 / road_step_m);
    std::vector<double> out;
    for (std::size_t i = 0; i < profile.centre_m.size(); ++i) {
        const double at_m = profile.start_travel_m + step_m * static_cast<double>(i);
        const auto middle = std::lround(at_m / road_step_m);
        double sum = 0;
        for (auto k = middle - reach; k <= middle + reach; ++k) {
            sum += road_m[static_cast<std::size_t>(k)];
        }
        out.push_back(sum / static_cast<double>(2 * reach + 1));
    }
    return out;
}

std::vector<double> doubles(const std::vector<float>& values) {
    return {values.begin(), values.end()};
}

double mean_of(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Waves of 1 to 30 m, without a shift.
template <typename Values>
std::vector<double> in_band(const Values& profile_m) {
    constexpr int order = 4;
    constexpr double shortest_m = 1;
    constexpr double longest_m = 30;
    const auto settle = static_cast<std::size_t>(3 * longest_m / step_m);
    const std::vector<double> all(profile_m.begin(), profile_m.end());
    const auto high =
        zero_phase(butterworth_highpass(order, 1 / longest_m, 1 / step_m), all, settle);
    return zero_phase(butterworth_lowpass(order, 1 / shortest_m, 1 / step_m), high, settle);
}

/// Of the middle parts, which have mean zero.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const auto keep_off = static_cast<std::size_t>(keep_off_m / step_m);
    double ab = 0;
    double aa = 0;
    double bb = 0;
    for (std::size_t i = keep_off; i + keep_off < a.size(); ++i) {
        ab += a[i] * b[i];
        aa += a[i] * a[i];
        bb += b[i] * b[i];
    }
    return ab / std::sqrt(aa * bb);
}

/// Both tracks and their mean, as truth and as estimate.
struct Beside {
    EstimatedProfile profile;
    std::vector<double> left_m, right_m, centre_m;
};

Beside beside(const DriveRecipe& drive, const Sensors& sensors = {}) {
    const auto paths = wheel_paths(make_surface(drive.road, drive.length_m, drive.seed));
    const auto stretch = with_sensors(driven_road(drive).stretch, sensors);
    Beside both{.profile = run_over(stretch).profile, .left_m = {}, .right_m = {}, .centre_m = {}};
    both.left_m = true_at(paths.left_m, paths.step_m, both.profile);
    both.right_m = true_at(paths.right_m, paths.step_m, both.profile);
    for (std::size_t i = 0; i < both.left_m.size(); ++i) {
        both.centre_m.push_back((both.left_m[i] + both.right_m[i]) / 2);
    }
    return both;
}

} // namespace

/// Waves of 1 to 30 m: 0.97 to 0.99 at 50 to 110 km/h with all sensors or the vertical one alone.
TEST(EstimatedProfile, CorrelatesWithTheRoadThatWasDriven) {
    for (const double speed_kmh : {50.0, 110.0}) {
        const auto road = beside(drive_of(2500, speed_kmh));
        const auto& [profile, left_m, right_m, centre_m] = road;
        const double left = correlation(in_band(profile.left_m), in_band(left_m));
        const double right = correlation(in_band(profile.right_m), in_band(right_m));
        std::printf("%.0f km/h: left %.3f, right %.3f\n", speed_kmh, left, right);
        EXPECT_GT(left, 0.95);
        EXPECT_GT(right, 0.95);
    }
    const auto road = beside(drive_of(2500, 80), {true, false, false, false});
    EXPECT_THAT(road.profile.left_m, IsEmpty());
    EXPECT_GT(correlation(in_band(road.profile.centre_m), in_band(road.centre_m)), 0.95);
}

/// The road that is most probable is a little smoother than those that could have been.
TEST(EstimatedProfile, IsAboutAsRoughAsTheTrace) {
    const auto run = run_over(driven_road(drive_of(2500, 80)).stretch);
    const double trace = mean_of(run.centre_mm_per_m);
    const double profile = iri_mm_per_m(doubles(run.profile.centre_m), step_m);
    std::printf("IRI of the profile %.3f, of the trace %.3f mm/m\n", profile, trace);
    EXPECT_GT(profile / trace, 0.93);
    EXPECT_LT(profile / trace, 1);
}

/// Pieces of 400 m: seams every 400 m, where a step of 1 mm would be a stroke of some mm/m.
TEST(EstimatedProfile, ShowsNoSeams) {
    const auto stretch = driven_road(drive_of(2500, 80)).stretch;
    const auto whole = run_over(stretch, {.core_m = 1e6, .core_samples = 1'000'000}).profile;
    const auto pieces = run_over(stretch, {.core_m = 400}).profile;
    ASSERT_THAT(pieces.left_m, SizeIs(whole.left_m.size()));
    const auto one = rectified_stroke_mm_per_m(doubles(whole.left_m), step_m);
    const auto joined = rectified_stroke_mm_per_m(doubles(pieces.left_m), step_m);
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        worst = std::max(worst, std::abs(static_cast<double>(one[i] - joined[i])));
    }
    std::printf("strokes differ by at most %.4f mm/m\n", worst);
    EXPECT_LT(worst, 0.15); // each piece finds the road's spectrum anew
}

TEST(EstimatedProfile, OfTheFilterIsWhatItsTraceWasMadeOf) {
    EstimatorConfig config;
    config.channels = Channels::vertical;
    config.profile = true;
    const auto run = estimate_iri(driven_road(drive_of(1000, 80)).stretch, car(), config);
    ASSERT_EQ(run.profile.start_travel_m, run.start_travel_m);
    const double profile = iri_mm_per_m(doubles(run.profile.centre_m), run.profile.step_m);
    EXPECT_NEAR(profile, mean_of(run.centre_mm_per_m), 0.01 * profile);
}

TEST(EstimatedProfile, IsNotKeptUnlessAskedFor) {
    const auto stretch = driven_road(drive_of(300, 80)).stretch;
    EXPECT_THAT(smoothed_iri(stretch, {.vehicle = car()}, {}).profile.centre_m, IsEmpty());
    EXPECT_THAT(estimate_iri(stretch, car(), {}).profile.centre_m, IsEmpty());
}

TEST(EstimatedProfile, OfTheLateralSensorAloneDoesNotExist) {
    const auto stretch =
        with_sensors(driven_road(drive_of(300, 80)).stretch, {false, true, false, false});
    EXPECT_THAT(run_over(stretch).profile.centre_m, IsEmpty());
    EXPECT_THAT(run_over(stretch).profile.left_m, IsEmpty());
}

} // namespace macadam::testing
