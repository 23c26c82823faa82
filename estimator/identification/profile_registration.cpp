#include "estimator/identification/profile_registration.hpp"

#include "estimator/motion/butterworth.hpp"
#include "estimator/roughness/unknown_input_filter.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

namespace macadam {
namespace {

constexpr double grid_m = 0.25;
constexpr double longest_wave_m = 20; // longer waves are attenuated by the filter at low speed
constexpr double shortest_wave_m = 3; // shorter waves decorrelate at 0.5 % travel error
constexpr double template_m = 300;
constexpr double min_m = 100;
constexpr double q_over_r = 1e9; // paper section VI-B
constexpr double settle_m = 60;
constexpr int filter_order = 4;

/// Elevations at evenly spaced positions.
struct EvenLine {
    double start_m;
    std::vector<double> elevation_m;
};

/// Filters the elevations to the band of wavelengths that is compared.
std::vector<double> banded(const std::vector<double>& elevation_m) {
    const double rate = 1 / grid_m;
    const auto settle = static_cast<std::size_t>(settle_m / grid_m);
    const auto short_off = zero_phase(
        butterworth_lowpass(filter_order, 1 / shortest_wave_m, rate), elevation_m, settle);
    return zero_phase(
        butterworth_highpass(filter_order, 1 / longest_wave_m, rate), short_off, settle);
}

EvenLine even_line(std::span<const double> at_m, std::span<const double> elevation_m) {
    EvenLine line{.start_m = at_m.front(), .elevation_m = {}};
    std::vector<double> grid;
    for (double at = at_m.front(); at <= at_m.back(); at += grid_m) {
        grid.push_back(at);
    }
    line.elevation_m = elevations_at(at_m, elevation_m, grid);
    return line;
}

/// Returns the Kalman filter's road under a stretch, without the settling distance.
EvenLine estimated_line(const Stretch& stretch, const Vehicle& vehicle) {
    UnknownInputFilter<4, 1, 1> filter{discretise(quarter_car(vehicle.half_car), stretch.step_s),
                                       q_over_r};
    std::vector<double> at_m;
    std::vector<double> road_m;
    for (std::size_t k = 0; k < stretch.travel_m.size(); ++k) {
        const double felt = static_cast<double>(stretch.vertical_mps2[k]);
        const double road = filter.push(Eigen::Vector<double, 1>{felt})[0];
        if (at_m.empty() || stretch.travel_m[k] > at_m.back()) {
            at_m.push_back(stretch.travel_m[k]);
            road_m.push_back(road);
        }
    }
    auto line = even_line(at_m, road_m);
    line.elevation_m = banded(line.elevation_m);
    const auto settling =
        std::min(line.elevation_m.size(), static_cast<std::size_t>(settle_m / grid_m));
    line.elevation_m.erase(line.elevation_m.begin(),
                           line.elevation_m.begin() + static_cast<std::ptrdiff_t>(settling));
    line.start_m += static_cast<double>(settling) * grid_m;
    return line;
}

/// Returns the mean profile at the car's centre of gravity.
EvenLine measured_line(const RoadProfile& profile, const Vehicle& vehicle) {
    auto line = even_line(profile.station_m, mean_of_tracks(profile));
    if (vehicle.axles) {
        const auto& axles = *vehicle.axles;
        std::vector<double> front, rear;
        for (std::size_t i = 0; i < line.elevation_m.size(); ++i) {
            const double at = line.start_m + static_cast<double>(i) * grid_m;
            front.push_back(at + axles.cg_to_front_m);
            rear.push_back(at + axles.cg_to_front_m - axles.wheelbase_m);
        }
        const auto mean_m = mean_of_tracks(profile);
        front = elevations_at(profile.station_m, mean_m, front);
        rear = elevations_at(profile.station_m, mean_m, rear);
        std::ranges::transform(
            front, rear, line.elevation_m.begin(), [](double f, double r) { return (f + r) / 2; });
    }
    line.elevation_m = banded(line.elevation_m);
    return line;
}

using Complexes = std::vector<std::complex<double>>;

/// Computes sum over i of part[i] * whole[i + lag] for every lag that keeps the part within the
/// whole.
std::vector<double> sliding_products(std::span<const double> part, std::span<const double> whole) {
    const std::size_t size = std::bit_ceil(whole.size() + part.size());
    std::vector<double> a(size), b(size);
    std::ranges::copy(part, a.begin());
    std::ranges::copy(whole, b.begin());
    Eigen::FFT<double> fourier;
    Complexes fa, fb;
    fourier.fwd(fa, a);
    fourier.fwd(fb, b);
    for (std::size_t i = 0; i < fa.size(); ++i) {
        fb[i] *= std::conj(fa[i]);
    }
    fourier.inv(a, fb);
    a.resize(whole.size() - part.size() + 1);
    return a;
}

std::vector<double> sliding_squares(std::size_t width, std::span<const double> whole) {
    std::vector<double> sums{0};
    for (const double value : whole) {
        sums.push_back(sums.back() + value * value);
    }
    std::vector<double> squares;
    for (std::size_t i = 0; i + width <= whole.size(); ++i) {
        squares.push_back(sums[i + width] - sums[i]);
    }
    return squares;
}

/// Finds the best position of a part of the trip. Both lines are band-passed and thus have zero
/// mean.
ProfileRegistration
best_place(std::span<const double> part, double part_start_m, const EvenLine& road) {
    const auto products = sliding_products(part, road.elevation_m);
    const auto squares = sliding_squares(part.size(), road.elevation_m);
    double own = 0;
    for (const double value : part) {
        own += value * value;
    }
    ProfileRegistration best{.at_m = 0, .correlation = -1, .compared_m = 0};
    for (std::size_t lag = 0; lag < products.size(); ++lag) {
        const double size = std::sqrt(own * squares[lag]);
        const double correlation = size > 0 ? products[lag] / size : 0;
        if (correlation > best.correlation) {
            best = {.at_m = road.start_m + static_cast<double>(lag) * grid_m - part_start_m,
                    .correlation = correlation,
                    .compared_m = static_cast<double>(part.size()) * grid_m};
        }
    }
    return best;
}

} // namespace

std::optional<ProfileRegistration>
find_place(std::span<const Stretch> stretches, const RoadProfile& profile, const Vehicle& vehicle) {
    const auto road = measured_line(profile, vehicle);
    const auto least = static_cast<std::size_t>(min_m / grid_m);
    std::optional<ProfileRegistration> best;
    for (const auto& stretch : stretches) {
        if (stretch.vertical_mps2.empty() || stretch.travel_m.size() < 2) {
            continue;
        }
        const auto line = estimated_line(stretch, vehicle);
        const std::span<const double> whole{line.elevation_m};
        const auto width = std::min(
            {static_cast<std::size_t>(template_m / grid_m), whole.size(), road.elevation_m.size()});
        for (std::size_t from = 0; width >= least && from + width <= whole.size();
             from += width / 2) {
            const auto place = best_place(whole.subspan(from, width),
                                          line.start_m + static_cast<double>(from) * grid_m,
                                          road);
            if (!best || place.correlation > best->correlation) {
                best = place;
            }
        }
    }
    return best;
}

} // namespace macadam
