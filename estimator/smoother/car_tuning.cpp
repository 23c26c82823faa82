#include "estimator/smoother/car_tuning.hpp"

#include "estimator/common/error.hpp"
#include "estimator/smoother/friction.hpp"
#include "estimator/smoother/vibration/car_from_vibration.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr double relative_step = 0.03; // of a finite difference
constexpr double friction_step_n = 20; // search step, for a car of usual_mass_kg
constexpr double max_friction_n = 120; // above this a suspension is stuck

// In simulated fleets the maximum of the likelihood lies this far from the true friction, for a car
// of usual_mass_kg: a sensor's unstated low-pass looks like less of it, uneven dampers like more
// (docs/decisions/42-friction-has-a-prior.md).
constexpr double friction_model_sd_n = 12;

/// Place of the sensor ahead of the centre of gravity, over the wheelbase, in a car whose dynamic
/// index is not known either: passengers and luggage move the centre, as in vehicle_prior.cpp.
constexpr double imu_x_sd = 0.03;

constexpr double furthest = 1.5; // from the stated values, in prior standard deviations
constexpr double trust = 0.25;   // weight of the likelihood, which ignores the model error
constexpr int steps = 2;

constexpr int first_rounds = 8; // from an even road
constexpr int more_rounds = 3;  // from the previous level

/// A car and the friction of each of its suspensions.
struct Point {
    Vehicle vehicle;
    double friction_n = 0;
};

/// Unknown that is moved from 0, its stated or usual value.
struct Unknown {
    void (*move)(Point&, double by);
    double prior_sd;
    double step; ///< of a finite difference
};
using Unknowns = std::vector<Unknown>;

template <double HalfCar::*parameter>
void times_exp(Point& point, double by) {
    point.vehicle.half_car.*parameter *= std::exp(by);
}

void dynamic_index_times_exp(Point& point, double by) {
    point.vehicle.axles->dynamic_index *= std::exp(by);
}

void imu_x_plus(Point& point, double by) {
    point.vehicle.imu.x_m += by * point.vehicle.axles->wheelbase_m;
}

// Mass and damping are not among them. Over a road that is not known either, their likelihood has a
// slope where the file is exact: a heavier or less damped car explains a bend of the road's
// spectrum or an unstated pitch inertia (docs/decisions/41-mass-and-damping-are-not-tuned.md).
constexpr std::pair<std::string_view, void (*)(Point&, double)> tuned_parameters[] = {
    {"ks_n_per_m", times_exp<&HalfCar::ks_n_per_m>},
    {"kt_n_per_m", times_exp<&HalfCar::kt_n_per_m>},
    {"dynamic_index", dynamic_index_times_exp},
    {found_imu_x, imu_x_plus},
};

/// Relative, per relative error of a parameter: 0.45 to 0.75 in simulations.
constexpr double iri_per_parameter = 0.6;

bool is_tuned(std::string_view parameter) {
    return std::ranges::any_of(tuned_parameters,
                               [&](const auto& tuned) { return tuned.first == parameter; });
}

/// Returns the tuned parameters that the vehicle has and declares uncertain.
Unknowns of_car(const Vehicle& vehicle) {
    Unknowns unknowns;
    for (const auto& [name, move] : tuned_parameters) {
        const auto found = vehicle.uncertainty.find(std::string{name});
        const bool has_it = vehicle.axles || (name != "dynamic_index" && name != found_imu_x);
        if (has_it && found != vehicle.uncertainty.end() && found->second > 0) {
            unknowns.push_back({move, found->second, relative_step});
            if (name == "dynamic_index" && !vehicle.uncertainty.contains(found_imu_x)) {
                unknowns.push_back({imu_x_plus, imu_x_sd, relative_step});
            }
        }
    }
    return unknowns;
}

Point moved(Point point, const Unknowns& unknowns, const Eigen::VectorXd& by) {
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
        unknowns[i].move(point, by[static_cast<Eigen::Index>(i)]);
    }
    return point;
}

struct TuningConfig {
    SmootherConfig smoother;
    std::stop_token stop;
};

RoadEstimate run(const DriveRecord& drive,
                 const Point& point,
                 const TuningConfig& config,
                 int rounds,
                 const RoadEstimate* begin) {
    if (config.stop.stop_requested()) {
        throw InputError{"interrupted"};
    }
    VehicleDrive car{drive, point.vehicle, point.friction_n};
    car.drive.cars = cars_with_friction(point.vehicle, drive.cars.front().step_s);
    auto once = config.smoother;
    once.rounds = rounds;
    once.settling = rounds - 1;
    return smooth_drives({std::move(car)}, once, begin);
}

double mean_stroke(const RoadEstimate& estimate) {
    double sum = 0;
    for (std::size_t i = 0; i < estimate.left_mm_per_m.size(); ++i) {
        sum += static_cast<double>(estimate.left_mm_per_m[i] + estimate.right_mm_per_m[i]);
    }
    return sum;
}

/// Local behaviour of the likelihood: its gradient and information, and the relative change of IRI
/// with the unknowns.
struct Slope {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd information;
    Eigen::VectorXd iri;
};

Slope slope_at(const RoadEstimate& here,
               const std::vector<RoadEstimate>& beside,
               const Unknowns& unknowns) {
    const auto n = static_cast<Eigen::Index>(beside.size());
    const auto samples = static_cast<Eigen::Index>(here.innovation.size());
    Eigen::MatrixXd by_mean(samples, n);
    Eigen::MatrixXd by_spread(samples, n);
    Slope slope{Eigen::VectorXd(n), {}, Eigen::VectorXd(n)};
    const Eigen::Map<const Eigen::VectorXd> e{here.innovation.data(), samples};
    const Eigen::Map<const Eigen::VectorXd> v{here.log_variance.data(), samples};
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto& other = beside[static_cast<std::size_t>(i)];
        const double step = unknowns[static_cast<std::size_t>(i)].step;
        const Eigen::Map<const Eigen::VectorXd> e2{other.innovation.data(), samples};
        const Eigen::Map<const Eigen::VectorXd> v2{other.log_variance.data(), samples};
        // Innovations are relative to their own sd: the changed ones are converted to the sd of the
        // reference.
        by_mean.col(i) = (e2.array() * ((v2 - v).array() / 2).exp() - e.array()) / step;
        by_spread.col(i) = (v2 - v) / step;
        slope.gradient[i] = -(e.array() * by_mean.col(i).array()).sum() -
                            (by_spread.col(i).array() * (1 - e.array().square())).sum() / 2;
        slope.iri[i] = (mean_stroke(other) / mean_stroke(here) - 1) / step;
    }
    slope.information = by_mean.transpose() * by_mean + by_spread.transpose() * by_spread / 2;
    return slope;
}

struct Friction {
    double force_n;
    double sd_n;
    double iri_per_n; ///< relative
};

/// Joins what was found with what is usual.
Friction joined(double found_n, double found_sd_n, double iri_per_n, const HalfCar& car) {
    const auto usual = usual_friction_n(car);
    const double trust_in_found = 1 / (1 + std::pow(found_sd_n / usual.sd, 2));
    return {.force_n = std::max(0.0, std::lerp(usual.mean, found_n, trust_in_found)),
            .sd_n = found_sd_n * std::sqrt(trust_in_found),
            .iri_per_n = iri_per_n};
}

/// Finds the friction that adds the damping that is shown, over the strokes of the drive.
Friction friction_of(const DriveRecord& drive,
                     Point point,
                     const ShownDamping& damping,
                     const TuningConfig& config) {
    const auto usual = usual_friction_n(point.vehicle.half_car);
    const auto with = [&](double friction_n) {
        point.friction_n = friction_n;
        return run(drive, point, config, first_rounds, nullptr);
    };
    const auto less = with(usual.mean / 2);
    const auto more = with(usual.mean * 3 / 2);
    const double added_per_n =
        (mean_added_damping(less.which.front()) + mean_added_damping(more.which.front())) /
        (2 * usual.mean);
    return joined(damping.added / added_per_n,
                  damping.sd / added_per_n,
                  (mean_stroke(more) / mean_stroke(less) - 1) / usual.mean,
                  point.vehicle.half_car);
}

/// Finds friction from the likelihood at even steps, with a parabola through the maximum.
Friction friction_by_likelihood(const DriveRecord& drive, Point point, const TuningConfig& config) {
    const double size = point.vehicle.half_car.ms_kg / usual_mass_kg;
    const double step_n = friction_step_n * size;
    std::vector<RoadEstimate> at; // each from an even road, to treat all alike
    const auto likelihood = [&](std::size_t i) { return at[i].log_likelihood; };
    while (at.size() < 3 || (likelihood(at.size() - 1) > likelihood(at.size() - 2) &&
                             static_cast<double>(at.size()) * step_n < max_friction_n * size)) {
        point.friction_n = static_cast<double>(at.size()) * step_n;
        at.push_back(run(drive, point, config, first_rounds, nullptr));
    }
    const std::size_t last = at.size() - 1;
    const double rise = likelihood(last) - likelihood(last - 2);
    const double bend = 2 * likelihood(last - 1) - likelihood(last) - likelihood(last - 2);
    const double peak = bend > 0 ? std::clamp(rise / (2 * bend), -1.5, 1.5) : rise > 0 ? 1.0 : -1.0;
    const double found_n = (static_cast<double>(last - 1) + peak) * step_n;
    const double found_sd_n =
        std::hypot(friction_model_sd_n * size, bend > 0 ? step_n / std::sqrt(bend) : step_n);
    return joined(std::max(0.0, found_n),
                  found_sd_n,
                  (mean_stroke(at[last]) / mean_stroke(at[last - 2]) - 1) / (2 * step_n),
                  point.vehicle.half_car);
}

/// Differentiates the likelihood about a point: the same road with one unknown moved at a time.
Slope slope_about(const DriveRecord& drive,
                  const Point& at,
                  const Unknowns& unknowns,
                  const TuningConfig& config,
                  RoadEstimate& here) {
    std::vector<RoadEstimate> beside;
    for (const auto& unknown : unknowns) {
        Point there = at;
        unknown.move(there, unknown.step);
        beside.push_back(run(drive, there, config, more_rounds, &here));
    }
    // The reference point gets the same number of rounds, so that only the unknowns differ.
    here = run(drive, at, config, more_rounds, &here);
    return slope_at(here, beside, unknowns);
}

/// Maximum of the posterior, by Gauss-Newton from the stated values.
struct Peak {
    Eigen::VectorXd by;
    double iri_sd; ///< relative; remaining uncertainty
};

Peak peak_about(const DriveRecord& drive,
                const Point& start,
                const Unknowns& unknowns,
                const TuningConfig& config) {
    const auto n = static_cast<Eigen::Index>(unknowns.size());
    Eigen::VectorXd prior_sd(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        prior_sd[i] = unknowns[static_cast<std::size_t>(i)].prior_sd;
    }
    const Eigen::MatrixXd prior = prior_sd.array().square().inverse().matrix().asDiagonal();
    Peak peak{Eigen::VectorXd::Zero(n), 0};
    auto here = run(drive, start, config, first_rounds, nullptr);
    for (int step = 0; step < steps && n > 0; ++step) {
        const auto slope =
            slope_about(drive, moved(start, unknowns, peak.by), unknowns, config, here);
        const Eigen::MatrixXd left = (trust * slope.information + prior).inverse();
        peak.by += left * (trust * slope.gradient - prior * peak.by);
        peak.by = peak.by.cwiseMin(furthest * prior_sd).cwiseMax(-furthest * prior_sd);
        peak.iri_sd = std::sqrt(slope.iri.dot(left * slope.iri));
    }
    return peak;
}

} // namespace

TunedCar tuned_car(const DriveRecord& drive,
                   const Vehicle& vehicle,
                   const SmootherConfig& smoother,
                   const std::optional<ShownDamping>& damping,
                   const std::stop_token& stop) {
    const TuningConfig config{smoother, stop};
    Point point{.vehicle = vehicle, .friction_n = vehicle.half_car.friction_n.value_or(0)};
    TunedCar tuned{.vehicle = vehicle};
    if (!vehicle.half_car.friction_n) {
        const auto friction = damping ? friction_of(drive, point, *damping, config)
                                      : friction_by_likelihood(drive, point, config);
        point.friction_n = friction.force_n;
        tuned.friction_sd_n = friction.sd_n;
        tuned.iri_sd = std::abs(friction.iri_per_n * friction.sd_n);
    }
    const auto unknowns = of_car(vehicle);
    const auto peak = peak_about(drive, point, unknowns, config);
    point = moved(point, unknowns, peak.by);
    tuned.vehicle = point.vehicle;
    tuned.friction_n = point.friction_n;
    tuned.iri_sd = std::hypot(tuned.iri_sd, peak.iri_sd, untuned_iri_sd(vehicle, true));
    return tuned;
}

double untuned_iri_sd(const Vehicle& vehicle, bool is_car_tuned) {
    double variance = 0;
    for (const auto& [parameter, sd] : vehicle.uncertainty) {
        if (!is_car_tuned || !is_tuned(parameter)) {
            variance += std::pow(iri_per_parameter * sd, 2);
        }
    }
    return std::sqrt(variance);
}

} // namespace macadam
