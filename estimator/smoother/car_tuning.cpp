#include "estimator/smoother/car_tuning.hpp"

#include "estimator/smoother/friction.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double relative_step = 0.03; // of a finite difference
constexpr double usual_mass_kg = 1400;
constexpr double friction_step_n = 20;  // of the search, for a car of usual_mass_kg
constexpr double most_friction_n = 120; // beyond, a suspension is stuck
constexpr double friction_offset_n = 5; // found on simulated cars that have none (docs/method.md)
constexpr double boldest = 2.5;         // of a step, in prior standard deviations
constexpr int steps = 2;
constexpr int first_rounds = 8; // from an even road
constexpr int more_rounds = 3;  // from the level that was found

/// A number of the vehicle that may be moved, as its logarithm.
struct Parameter {
    const char* name;
    double& (*of)(Vehicle&);
};

constexpr Parameter parameters[] = {
    {"cs_ns_per_m", [](Vehicle& v) -> double& { return v.half_car.cs_ns_per_m; }},
    {"ks_n_per_m", [](Vehicle& v) -> double& { return v.half_car.ks_n_per_m; }},
    {"kt_n_per_m", [](Vehicle& v) -> double& { return v.half_car.kt_n_per_m; }},
    {"ms_kg", [](Vehicle& v) -> double& { return v.half_car.ms_kg; }},
};

/// What is moved: the parameters that are uncertain.
struct Unknowns {
    std::vector<const Parameter*> moved;
    Eigen::VectorXd prior_sd; ///< of their logarithms, about what is stated
};

Unknowns unknowns_of(const Vehicle& vehicle) {
    Unknowns unknowns;
    std::vector<double> sd;
    for (const auto& parameter : parameters) {
        const auto found = vehicle.uncertainty.find(parameter.name);
        if (found != vehicle.uncertainty.end() && found->second > 0) {
            unknowns.moved.push_back(&parameter);
            sd.push_back(found->second);
        }
    }
    unknowns.prior_sd =
        Eigen::Map<const Eigen::VectorXd>{sd.data(), static_cast<Eigen::Index>(sd.size())};
    return unknowns;
}

Vehicle moved(Vehicle vehicle, const Unknowns& unknowns, const Eigen::VectorXd& at) {
    for (std::size_t i = 0; i < unknowns.moved.size(); ++i) {
        unknowns.moved[i]->of(vehicle) *= std::exp(at[static_cast<Eigen::Index>(i)]);
    }
    return vehicle;
}

RoadEstimate run(const Passage& passage,
                 const Vehicle& vehicle,
                 double friction_n,
                 const SmootherConfig& config,
                 int rounds,
                 const RoadEstimate* begin) {
    CarPassage car{passage, vehicle, friction_n};
    car.passage.cars = cars_with_friction(vehicle, passage.cars.front().step_s);
    auto once = config;
    once.rounds = rounds;
    once.settling = rounds - 1;
    return smooth_passages({std::move(car)}, once, begin);
}

double mean_stroke(const RoadEstimate& estimate) {
    double sum = 0;
    for (std::size_t i = 0; i < estimate.left_mm_per_m.size(); ++i) {
        sum += static_cast<double>(estimate.left_mm_per_m[i] + estimate.right_mm_per_m[i]);
    }
    return sum;
}

/// The likelihood about a point: its gradient and information, and how the IRI goes with the
/// unknowns (relative).
struct Slope {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd information;
    Eigen::VectorXd iri;
};

Slope slope_at(const RoadEstimate& here, const std::vector<RoadEstimate>& beside) {
    const auto n = static_cast<Eigen::Index>(beside.size());
    const auto samples = static_cast<Eigen::Index>(here.innovation.size());
    Eigen::MatrixXd by_mean(samples, n);
    Eigen::MatrixXd by_spread(samples, n);
    Slope slope{Eigen::VectorXd(n), {}, Eigen::VectorXd(n)};
    const Eigen::Map<const Eigen::VectorXd> e{here.innovation.data(), samples};
    const Eigen::Map<const Eigen::VectorXd> v{here.log_variance.data(), samples};
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto& other = beside[static_cast<std::size_t>(i)];
        const Eigen::Map<const Eigen::VectorXd> e2{other.innovation.data(), samples};
        const Eigen::Map<const Eigen::VectorXd> v2{other.log_variance.data(), samples};
        // Innovations are over their own sd: what moves them is taken at the sd of here.
        by_mean.col(i) = (e2.array() * ((v2 - v).array() / 2).exp() - e.array()) / relative_step;
        by_spread.col(i) = (v2 - v) / relative_step;
        slope.gradient[i] = -(e.array() * by_mean.col(i).array()).sum() -
                            (by_spread.col(i).array() * (1 - e.array().square())).sum() / 2;
        slope.iri[i] = (mean_stroke(other) / mean_stroke(here) - 1) / relative_step;
    }
    slope.information = by_mean.transpose() * by_mean + by_spread.transpose() * by_spread / 2;
    return slope;
}

/// Friction by the likelihood at even steps, and a parabola through the highest.
struct Friction {
    double force_n;
    double sd_n;
    double iri_per_n; ///< relative
};

Friction friction_of(const Passage& passage, const Vehicle& vehicle, const SmootherConfig& config) {
    const double size = vehicle.half_car.ms_kg / usual_mass_kg;
    const double step_n = friction_step_n * size;
    std::vector<RoadEstimate> at; // each from an even road, so that none is favoured
    const auto likelihood = [&](std::size_t i) { return at[i].log_likelihood; };
    while (at.size() < 3 || (likelihood(at.size() - 1) > likelihood(at.size() - 2) &&
                             static_cast<double>(at.size()) * step_n < most_friction_n * size)) {
        const double force_n = static_cast<double>(at.size()) * step_n;
        at.push_back(run(passage, vehicle, force_n, config, first_rounds, nullptr));
    }
    const std::size_t last = at.size() - 1;
    const double rise = likelihood(last) - likelihood(last - 2);
    const double bend = 2 * likelihood(last - 1) - likelihood(last) - likelihood(last - 2);
    const double peak = bend > 0 ? std::clamp(rise / (2 * bend), -1.5, 1.5) : rise > 0 ? 1.0 : -1.0;
    const double found_n = (static_cast<double>(last - 1) + peak) * step_n;
    const double offset_n = friction_offset_n * size;
    return {.force_n = std::max(0.0, found_n - offset_n),
            .sd_n = std::hypot(offset_n, bend > 0 ? step_n / std::sqrt(bend) : step_n),
            .iri_per_n = (mean_stroke(at[last]) / mean_stroke(at[last - 2]) - 1) / (2 * step_n)};
}

/// How a parameter's neighbourhood looks: the same road with one after the other moved.
Slope slope_about(const Passage& passage,
                  const Vehicle& vehicle,
                  const Unknowns& unknowns,
                  const Eigen::VectorXd& at,
                  double friction_n,
                  const SmootherConfig& config,
                  RoadEstimate& here) {
    std::vector<RoadEstimate> beside;
    for (Eigen::Index i = 0; i < at.size(); ++i) {
        Eigen::VectorXd there = at;
        there[i] += relative_step;
        beside.push_back(
            run(passage, moved(vehicle, unknowns, there), friction_n, config, more_rounds, &here));
    }
    // The point itself after as many rounds, so that only the parameters differ.
    here = run(passage, moved(vehicle, unknowns, at), friction_n, config, more_rounds, &here);
    return slope_at(here, beside);
}

} // namespace

TunedCar tuned_car(const Passage& passage, const Vehicle& vehicle, const SmootherConfig& config) {
    TunedCar tuned{.vehicle = vehicle};
    double variance = 0; // relative, of the IRI
    if (vehicle.half_car.friction_n) {
        tuned.friction_n = *vehicle.half_car.friction_n;
    } else {
        const auto friction = friction_of(passage, vehicle, config);
        tuned.friction_n = friction.force_n;
        tuned.friction_sd_n = friction.sd_n;
        variance += std::pow(friction.iri_per_n * friction.sd_n, 2);
    }
    const auto unknowns = unknowns_of(vehicle);
    if (!unknowns.moved.empty()) {
        const Eigen::MatrixXd prior =
            unknowns.prior_sd.array().square().inverse().matrix().asDiagonal();
        Eigen::VectorXd at = Eigen::VectorXd::Zero(unknowns.prior_sd.size());
        auto here = run(passage, vehicle, tuned.friction_n, config, first_rounds, nullptr);
        for (int step = 0; step < steps; ++step) {
            const auto slope =
                slope_about(passage, vehicle, unknowns, at, tuned.friction_n, config, here);
            const Eigen::MatrixXd left = (slope.information + prior).inverse();
            const Eigen::VectorXd by = left * (slope.gradient - prior * at);
            const double bold = (by.array() / unknowns.prior_sd.array()).abs().maxCoeff();
            at += by * std::min(1.0, boldest / std::max(bold, 1e-9));
            if (step + 1 == steps) {
                variance += slope.iri.dot(left * slope.iri);
            }
        }
        tuned.vehicle = moved(vehicle, unknowns, at);
    }
    tuned.iri_sd = std::sqrt(variance);
    return tuned;
}

} // namespace macadam
