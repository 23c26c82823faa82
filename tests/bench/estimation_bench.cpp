// What estimation costs: the product's Kalman filter beside the same equations written down as they
// stand in the paper, on one trip of doubling length; and the smoother, on simulated drives.

#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/roughness/unknown_input_filter.hpp"
#include "estimator/smoother/driven_road.hpp"
#include "estimator/smoother/smoothed_iri.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <sys/resource.h>

#include <cmath>
#include <random>

namespace macadam {
namespace {

constexpr double rate_hz = 100;
constexpr double speed_mps = 20;

/// Vibration of the right size; what it says of the road does not matter here.
Stretch shaken(std::size_t samples) {
    std::mt19937 random{5};
    std::normal_distribution<float> shake{0, 0.8F};
    Stretch stretch{.start_s = 0,
                    .step_s = 1 / rate_hz,
                    .vertical_mps2 = std::vector<float>(samples),
                    .lateral_mps2 = {},
                    .roll_radps = {},
                    .pitch_radps = {},
                    .yaw_radps = {},
                    .speed_mps = std::vector<float>(samples, speed_mps),
                    .travel_m = std::vector<double>(samples)};
    for (std::size_t i = 0; i < samples; ++i) {
        stretch.vertical_mps2[i] = shake(random);
        stretch.travel_m[i] = speed_mps / rate_hz * static_cast<double>(i);
    }
    return stretch;
}

/// The paper's recursion for state and input with matrices of any size, the covariance carried on
/// at every sample and the road found through the inverse of the state's covariance.
std::vector<double> as_in_the_paper(const Stretch& stretch, const Vehicle& vehicle) {
    const auto car = discretise(quarter_car(vehicle.half_car), stretch.step_s);
    const Eigen::MatrixXd f = car.a;
    const Eigen::MatrixXd g = car.b;
    const Eigen::MatrixXd h = car.c;
    const Eigen::MatrixXd r = Eigen::MatrixXd::Identity(1, 1);
    const Eigen::MatrixXd q = 1e9 * Eigen::MatrixXd::Identity(1, 1);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(4);
    Eigen::MatrixXd p = 1e4 * Eigen::MatrixXd::Identity(4, 4);
    std::vector<double> road;
    road.reserve(stretch.vertical_mps2.size());
    for (const double y : stretch.vertical_mps2) {
        const Eigen::VectorXd predicted = f * x;
        const Eigen::MatrixXd before = f * p * f.transpose() + g * q * g.transpose();
        const Eigen::MatrixXd s = h * before * h.transpose() + r;
        const Eigen::MatrixXd k = before * h.transpose() * s.inverse();
        x = predicted + k * (Eigen::VectorXd::Constant(1, y) - h * predicted);
        const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(4, 4) - k * h;
        p = rest * before * rest.transpose() + k * r * k.transpose();
        const Eigen::VectorXd u = q * g.transpose() * before.inverse() * (x - predicted);
        road.push_back(u[0]);
    }
    return road;
}

std::vector<double> settled(const Stretch& stretch, const Vehicle& vehicle) {
    UnknownInputFilter<4, 1, 1> filter{discretise(quarter_car(vehicle.half_car), stretch.step_s),
                                       1e9};
    std::vector<double> road;
    road.reserve(stretch.vertical_mps2.size());
    for (const double y : stretch.vertical_mps2) {
        road.push_back(filter.push(Eigen::Vector<double, 1>{y})[0]);
    }
    return road;
}

void tell(benchmark::State& state, std::size_t samples) {
    const auto done = static_cast<double>(samples) * static_cast<double>(state.iterations());
    state.counters["samples/s"] = benchmark::Counter(done, benchmark::Counter::kIsRate);
    state.counters["x_real_time"] = benchmark::Counter(done / rate_hz, benchmark::Counter::kIsRate);
    state.SetComplexityN(static_cast<std::int64_t>(samples));
}

void filter_as_in_the_paper(benchmark::State& state) {
    const auto stretch = shaken(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(as_in_the_paper(stretch, *built_in_vehicle("generic")));
    }
    tell(state, stretch.travel_m.size());
}

void filter_of_macadam(benchmark::State& state) {
    const auto stretch = shaken(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(settled(stretch, *built_in_vehicle("generic")));
    }
    tell(state, stretch.travel_m.size());
}

/// From vibration to the golden car's stroke: filters, road, resampling, golden car.
void vibration_to_iri(benchmark::State& state) {
    const auto stretch = shaken(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(estimate_iri(stretch, *built_in_vehicle("generic"), {}));
    }
    tell(state, stretch.travel_m.size());
}

/// A drive at 50 Hz and 80 km/h, both tracks felt by every sensor.
testing::DriveRecipe felt_drive(double length_m) {
    const auto car = testing::two_axle_car({.wheelbase_m = 2.8, .cg_to_front_m = 1.3}, 0.3);
    return {.road = {.iri_mm_per_m = 2}, .car = testing::linear_car_of(car), .length_m = length_m};
}

void tell_of_smoother(benchmark::State& state, const Stretch& stretch) {
    const auto samples = static_cast<double>(stretch.travel_m.size());
    const double done = samples * static_cast<double>(state.iterations());
    state.counters["x_real_time"] =
        benchmark::Counter(done * stretch.step_s, benchmark::Counter::kIsRate);
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    state.counters["peak_MB"] = static_cast<double>(used.ru_maxrss) / 1024;
    state.SetComplexityN(static_cast<std::int64_t>(samples));
}

/// Twelve rounds of adaptation of the road's level, the car known.
void smoother_of_two_axles(benchmark::State& state) {
    const auto drive = felt_drive(static_cast<double>(state.range(0)));
    const auto stretch = driven_road(drive).stretch;
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            smoothed_iri(stretch, TunedCar{.vehicle = drive.car.vehicle}, EstimatorConfig{}));
    }
    tell_of_smoother(state, stretch);
}

/// What a one-axle vehicle file costs; that the car had two does not matter here.
void smoother_of_one_axle(benchmark::State& state) {
    const auto drive = felt_drive(static_cast<double>(state.range(0)));
    const auto stretch = driven_road(drive).stretch;
    Vehicle car = drive.car.vehicle;
    car.axles.reset();
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            smoothed_iri(stretch, TunedCar{.vehicle = car}, EstimatorConfig{}));
    }
    tell_of_smoother(state, stretch);
}

/// Once a trip: friction, and six parameters that are uncertain by 5 %.
void tuning_of_a_car(benchmark::State& state) {
    const auto drive = felt_drive(static_cast<double>(state.range(0)));
    const auto stretch = driven_road(drive).stretch;
    Vehicle car = drive.car.vehicle;
    for (const char* name :
         {"ms_kg", "mu_kg", "ks_n_per_m", "cs_ns_per_m", "kt_n_per_m", "is_kgm2"}) {
        car.uncertainty[name] = 0.05;
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(car_in(stretch, {.vehicle = car}, EstimatorConfig{}));
    }
    tell_of_smoother(state, stretch);
}

constexpr std::int64_t quarter_of_an_hour = 90'000;

BENCHMARK(filter_as_in_the_paper)->Arg(quarter_of_an_hour)->Unit(benchmark::kMillisecond);
BENCHMARK(filter_of_macadam)->Arg(quarter_of_an_hour)->Unit(benchmark::kMillisecond);
BENCHMARK(vibration_to_iri)
    ->RangeMultiplier(2)
    ->Range(quarter_of_an_hour, 8 * quarter_of_an_hour)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(smoother_of_one_axle)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(tuning_of_a_car)->Arg(4000)->Unit(benchmark::kMillisecond);
BENCHMARK(smoother_of_two_axles)
    ->RangeMultiplier(2)
    ->Range(2000, 16000)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace macadam
