#include "estimator/smoother/friction.hpp"

#include "corners.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

constexpr double cell_m = 0.25;
constexpr double step_s = 0.01;
constexpr double run_m = 0.2; // of a sample: 20 m/s
constexpr double harder = 1.06;
constexpr double half_a_car = 0.03; // between one car and the next, as a logarithm

/// Like ends, so that both do the same where the road is as long as the wheelbase.
Vehicle even_car() {
    auto vehicle = lopsided_car();
    vehicle.axles =
        Axles{.wheelbase_m = 2.5, .cg_to_front_m = 1.25, .dynamic_index = 1, .rear_ratio = 1};
    return vehicle;
}

DriveRecord drive_over(const Vehicle& vehicle, double length_m) {
    DriveRecord drive;
    drive.cars = cars_with_friction(vehicle, step_s);
    for (double at_m = 5; at_m < length_m - 5; at_m += run_m) {
        drive.travel_m.push_back(at_m);
    }
    return drive;
}

RoadGrid grid_of(const std::vector<Pair>& road_m) {
    return {cell_m, 0, road_m.size()};
}

std::vector<Pair> sines(double wave_m, double height_m, double length_m) {
    std::vector<Pair> road_m;
    for (double at_m = 0; at_m < length_m; at_m += cell_m) {
        road_m.push_back({height_m * std::sin(2 * std::numbers::pi * at_m / wave_m), 0});
    }
    return road_m;
}

std::vector<Pair> chance(double rise_m, double length_m) {
    std::mt19937 random{3};
    std::normal_distribution<double> normal;
    std::vector<Pair> road_m(1);
    while (static_cast<double>(road_m.size()) * cell_m < length_m) {
        road_m.push_back({road_m.back().mean + rise_m * normal(random),
                          0.97 * road_m.back().half + 0.5 * rise_m * normal(random)});
    }
    return road_m;
}

/// Speeds of the four strokes over a road, from the wheels' and the body's corners.
std::vector<double>
stroke_rates(const Vehicle& vehicle, const DriveRecord& drive, const std::vector<Pair>& road_m) {
    std::vector<double> rates;
    for (const auto& x : simulate_response(drive, grid_of(road_m), road_m)) {
        const auto corners = corners_of(x);
        const auto& rate = corners.rate;
        for (std::size_t wheel = 0; wheel < 4; ++wheel) {
            const double ahead_m = wheel < 2 ? 1.25 : -1.25;
            const double left_m = (wheel % 2 == 0 ? 1 : -1) * vehicle.half_car.l_m;
            rates.push_back(rate[3 + wheel] - (rate[0] - ahead_m * rate[1] + left_m * rate[2]));
        }
    }
    return rates;
}

/// The damping that holds in the middle of the drive, over the car's own; a mean over the middle
/// half, in the logarithm.
double log_damping(const std::vector<std::uint8_t>& which) {
    double sum = 0;
    const std::size_t from = which.size() / 4;
    const std::size_t to = 3 * which.size() / 4;
    for (std::size_t k = from; k < to; ++k) {
        sum += which[k] * std::log(harder);
    }
    return sum / static_cast<double>(to - from);
}

} // namespace

TEST(Friction, GivesCarsOfWhichTheFirstIsTheVehicleAndEachNextIsHarderBySixPercent) {
    const auto vehicle = even_car();
    const auto cars = cars_with_friction(vehicle, step_s);
    auto expected = vehicle;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        EXPECT_LT((cars[i].car.a - linear_car(expected).a).norm(), 1e-9 * cars[i].car.a.norm());
        expected.half_car.cs_ns_per_m *= harder;
    }
    EXPECT_GE(cars.size(), 20);
}

/// A damper takes 4 F A out of a turn of a stroke A sin(w t) as friction, c pi A^2 w as a damper:
/// c = 4 F / (pi A w). The road's wave is the wheelbase, so the ends do the same and the stroke's
/// speed A w is that of any corner.
TEST(Friction, OnASineDampsAsTheDamperOfTheSameWork) {
    const auto vehicle = even_car();
    const auto drive = drive_over(vehicle, 300);
    const auto road_m = sines(2.5, 0.004, 300);
    auto rates = stroke_rates(vehicle, drive, road_m);
    rates.erase(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2));
    const double speed_mps = std::ranges::max(rates);
    ASSERT_GT(speed_mps, 0.1);
    const double friction_n = 60;
    const auto which =
        damping_with_friction(drive, vehicle, grid_of(road_m), {{road_m}}, friction_n);
    const double added = 4 * friction_n / (std::numbers::pi * speed_mps);
    // Friction that begins at 5 mm/s takes up to 1 % less.
    EXPECT_NEAR(
        log_damping(which), std::log1p(added / vehicle.half_car.cs_ns_per_m), half_a_car + 0.01);
}

/// Of a Gaussian speed of deviation s: c = F sqrt(2 / pi) / s.
TEST(Friction, OnAGaussianRoadDampsAsStatisticalLinearisationSays) {
    const auto vehicle = even_car();
    const auto drive = drive_over(vehicle, 1500);
    const auto road_m = chance(0.0012, 1500);
    // Front and rear suspension, left and right, are as fast as one another on such a road: one
    // deviation. Within 50 m it scatters by some 7 %, of which the mean over 700 m leaves 2 %.
    double square = 0;
    const auto rates = stroke_rates(vehicle, drive, road_m);
    for (const double rate : rates) {
        square += rate * rate;
    }
    const double sd_mps = std::sqrt(square / static_cast<double>(rates.size()));
    ASSERT_GT(sd_mps, 0.03);
    const double friction_n = 60;
    const auto which =
        damping_with_friction(drive, vehicle, grid_of(road_m), {{road_m}}, friction_n);
    const double added = friction_n * std::sqrt(2 / std::numbers::pi) / sd_mps;
    EXPECT_NEAR(log_damping(which), std::log1p(added / vehicle.half_car.cs_ns_per_m), 0.03);
}

TEST(Friction, OfNothingChangesNothing) {
    const auto vehicle = even_car();
    const auto drive = drive_over(vehicle, 200);
    const auto road_m = chance(0.0012, 200);
    const auto which = damping_with_friction(drive, vehicle, grid_of(road_m), {{road_m}}, 0);
    EXPECT_EQ(which.size(), drive.travel_m.size());
    EXPECT_EQ(std::ranges::max(which), 0);
}

TEST(Friction, HoldsTheCarHarderOnASmootherRoad) {
    const auto vehicle = even_car();
    const auto drive = drive_over(vehicle, 600);
    auto road_m = chance(0.0004, 300);
    for (const auto& pair : chance(0.002, 300)) {
        road_m.push_back({pair.mean, pair.half});
    }
    const auto which = damping_with_friction(drive, vehicle, grid_of(road_m), {{road_m}}, 30);
    const auto at = [&](double at_m) {
        return which[static_cast<std::size_t>((at_m - 5) / run_m)];
    };
    EXPECT_GT(at(200), at(450) + 2);
}

TEST(Friction, OnALevelRoadIsNoDamper) {
    const auto vehicle = even_car();
    const auto drive = drive_over(vehicle, 100);
    const std::vector<Pair> road_m(400);
    const auto which = damping_with_friction(drive, vehicle, grid_of(road_m), {{road_m}}, 50);
    EXPECT_EQ(std::ranges::max(which), 0) << "nothing moves";
}

} // namespace macadam::testing
