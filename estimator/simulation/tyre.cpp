#include "estimator/simulation/tyre.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {

namespace {

using std::numbers::pi;

constexpr double radius_spread = 0.003; // of wheels on one car: about a millimetre of wear
constexpr double turns_ahead = 1000;    // keeps a little travel before the start positive

void check(const RoadUnderWheels& road, double contact_m) {
    if (road.left_m.size() != road.right_m.size() || road.left_m.size() < 2 || !(road.step_m > 0)) {
        throw InputError{fmt::format("road: {} and {} elevations at {} m, expected two or more, as "
                                     "many left as right",
                                     road.left_m.size(),
                                     road.right_m.size(),
                                     road.step_m)};
    }
    if (!(contact_m >= 0 && contact_m <= 1)) {
        throw InputError{fmt::format("car: tyre_contact_m is {}, expected 0 to 1", contact_m)};
    }
}

/// Averages the straight lines between stations over contact_m around each station.
std::vector<float>
smoothed(const std::vector<float>& elevation_m, double step_m, double contact_m) {
    const double half = contact_m / 2 / step_m; // in stations
    if (half == 0) {
        return elevation_m;
    }
    const auto last = static_cast<std::ptrdiff_t>(elevation_m.size() - 1);
    const auto at = [&](std::ptrdiff_t i) {
        return static_cast<double>(
            elevation_m[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))]);
    };
    const auto whole = static_cast<std::ptrdiff_t>(half);
    const double rest = half - static_cast<double>(whole);
    std::vector<float> mean(elevation_m.size());
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        double sum = 0; // twice the area under the lines
        for (std::ptrdiff_t k = i - whole; k < i + whole; ++k) {
            sum += at(k) + at(k + 1);
        }
        for (const std::ptrdiff_t side : {-1, 1}) {
            const double from = at(i + side * whole);
            const double rise = at(i + side * (whole + 1)) - from;
            sum += rest * (2 * from + rest * rise);
        }
        mean[static_cast<std::size_t>(i)] = static_cast<float>(sum / (4 * half));
    }
    return mean;
}

} // namespace

EnvelopedRoad::EnvelopedRoad(const RoadUnderWheels& road, double contact_m)
    : per_m_{1 / road.step_m}, last_{static_cast<double>(road.left_m.size()) - 1} {
    check(road, contact_m);
    const auto left_m = smoothed(road.left_m, road.step_m, contact_m);
    const auto right_m = smoothed(road.right_m, road.step_m, contact_m);
    station_.reserve(left_m.size() + 3);
    station_.push_back({left_m.front(), right_m.front()});
    for (std::size_t i = 0; i < left_m.size(); ++i) {
        station_.push_back({left_m[i], right_m[i]});
    }
    station_.resize(left_m.size() + 3, station_.back());
}

EnvelopedRoad::Heights EnvelopedRoad::at(double station_m) const {
    const double place = std::min(std::max(station_m * per_m_, 0.0), last_);
    const auto base = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(base);
    // Catmull-Rom cubic.
    const double weight[] = {t * (-0.5 + t * (1 - 0.5 * t)),
                             1 + t * t * (-2.5 + 1.5 * t),
                             t * (0.5 + t * (2 - 1.5 * t)),
                             t * t * (-0.5 + 0.5 * t)};
    Heights heights{0, 0};
    for (std::size_t k = 0; k < 4; ++k) {
        heights.left_m += weight[k] * static_cast<double>(station_[base + k].left_m);
        heights.right_m += weight[k] * static_cast<double>(station_[base + k].right_m);
    }
    return heights;
}

TyreNonUniformity::TyreNonUniformity(const CarRecipe& car, Random& random) {
    if (!(car.tyre_radius_m >= 0.1 && car.tyre_radius_m <= 1)) {
        throw InputError{
            fmt::format("car: tyre_radius_m is {}, expected 0.1 to 1", car.tyre_radius_m)};
    }
    const double first_m = car.tyre_nonuniformity_n / car.vehicle.half_car.kt_n_per_m;
    const double second_m = car.tyre_second_harmonic_n / car.vehicle.half_car.kt_n_per_m;
    for (std::size_t wheel = 0; wheel < 4; ++wheel) {
        const double radius_m =
            car.tyre_radius_m * (1 + random.uniform(-radius_spread, radius_spread));
        turns_per_m_[wheel] = 1 / (2 * pi * radius_m);
        const double first_phase = random.uniform(0, 2 * pi);
        const double second_phase = random.uniform(0, 2 * pi);
        for (std::size_t part = 0; part <= part_count; ++part) {
            const double angle =
                2 * pi * static_cast<double>(part) / static_cast<double>(part_count);
            height_m_[wheel][part] = first_m * std::cos(angle + first_phase) +
                                     second_m * std::cos(2 * angle + second_phase);
        }
    }
}

double TyreNonUniformity::at(std::size_t wheel, double travel_m) const {
    const double turns = turns_ahead + travel_m * turns_per_m_[wheel];
    const double turn = turns - static_cast<double>(static_cast<std::int64_t>(turns));
    const double place = turn * static_cast<double>(part_count);
    const auto part = static_cast<std::size_t>(place);
    const double from_m = height_m_[wheel][part];
    return from_m + (place - static_cast<double>(part)) * (height_m_[wheel][part + 1] - from_m);
}

} // namespace macadam
