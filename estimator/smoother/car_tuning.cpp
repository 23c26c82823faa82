#include "estimator/smoother/car_tuning.hpp"

#include "estimator/smoother/friction.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double relative_step = 0.03; // of a finite difference
constexpr double friction_step_n = 6;
constexpr double usual_friction_n = 20; // of a suspension of a car of usual_mass_kg, ...
constexpr double friction_prior_n = 30; // ... and how far it may be from that
constexpr double usual_mass_kg = 1400;
constexpr double boldest = 2.5; // of a step, in prior standard deviations
constexpr int steps = 2;
constexpr int first_rounds = 8; // from an even road
constexpr int more_rounds = 2;  // from the level that was found

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

/// What is moved: friction first, then the parameters that are uncertain.
struct Unknowns {
    std::vector<const Parameter*> moved;
    Eigen::VectorXd expected; ///< N, and logarithms' offsets from the stated value (0)
    Eigen::VectorXd prior_sd;
    Eigen::VectorXd step; ///< of the finite differences
};

Unknowns unknowns_of(const Vehicle& vehicle) {
    Unknowns unknowns;
    for (const auto& parameter : parameters) {
        const auto found = vehicle.uncertainty.find(parameter.name);
        if (found != vehicle.uncertainty.end() && found->second > 0) {
            unknowns.moved.push_back(&parameter);
        }
    }
    const auto n = static_cast<Eigen::Index>(unknowns.moved.size()) + 1;
    const double size = vehicle.half_car.ms_kg / usual_mass_kg;
    unknowns.expected = Eigen::VectorXd::Zero(n);
    unknowns.prior_sd = Eigen::VectorXd::Zero(n);
    unknowns.step = Eigen::VectorXd::Constant(n, relative_step);
    unknowns.expected[0] = usual_friction_n * size;
    unknowns.prior_sd[0] = friction_prior_n * size;
    unknowns.step[0] = friction_step_n * size;
    for (Eigen::Index i = 1; i < n; ++i) {
        unknowns.prior_sd[i] =
            vehicle.uncertainty.at(unknowns.moved[static_cast<std::size_t>(i - 1)]->name);
    }
    return unknowns;
}

Vehicle moved(Vehicle vehicle, const Unknowns& unknowns, const Eigen::VectorXd& at) {
    for (std::size_t i = 0; i < unknowns.moved.size(); ++i) {
        unknowns.moved[i]->of(vehicle) *= std::exp(at[static_cast<Eigen::Index>(i) + 1]);
    }
    return vehicle;
}

RoadEstimate run(const Passage& passage,
                 const Vehicle& vehicle,
                 const Unknowns& unknowns,
                 const Eigen::VectorXd& at,
                 const SmootherConfig& config,
                 int rounds,
                 const RoadEstimate* begin) {
    CarPassage car{passage, moved(vehicle, unknowns, at), std::max(0.0, at[0])};
    car.passage.cars = cars_with_friction(car.vehicle, passage.cars.front().step_s);
    for (auto& felt : {Channel::vertical, Channel::lateral}) {
        for (double& value : car.passage.felt[static_cast<std::size_t>(felt)]) {
            value *= vehicle.gain / car.vehicle.gain;
        }
    }
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
        const Eigen::Map<const Eigen::VectorXd> e2{other.innovation.data(), samples};
        const Eigen::Map<const Eigen::VectorXd> v2{other.log_variance.data(), samples};
        const double step = unknowns.step[i];
        // Innovations are over their own sd: what moves them is taken at the sd of here.
        by_mean.col(i) = (e2.array() * ((v2 - v).array() / 2).exp() - e.array()) / step;
        by_spread.col(i) = (v2 - v) / step;
        slope.gradient[i] = -(e.array() * by_mean.col(i).array()).sum() -
                            (by_spread.col(i).array() * (1 - e.array().square())).sum() / 2;
        slope.iri[i] = (mean_stroke(other) / mean_stroke(here) - 1) / step;
    }
    slope.information = by_mean.transpose() * by_mean + by_spread.transpose() * by_spread / 2;
    return slope;
}

} // namespace

TunedCar tuned_car(const Passage& passage, const Vehicle& vehicle, const SmootherConfig& config) {
    const auto unknowns = unknowns_of(vehicle);
    const auto n = unknowns.expected.size();
    const Eigen::MatrixXd prior =
        unknowns.prior_sd.array().square().inverse().matrix().asDiagonal();
    Eigen::VectorXd at = unknowns.expected;
    auto here = run(passage, vehicle, unknowns, at, config, first_rounds, nullptr);
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd iri = Eigen::VectorXd::Zero(n);
    for (int step = 0; step < steps; ++step) {
        here = run(passage, vehicle, unknowns, at, config, more_rounds, &here);
        std::vector<RoadEstimate> beside;
        for (Eigen::Index i = 0; i < n; ++i) {
            Eigen::VectorXd there = at;
            there[i] += unknowns.step[i];
            beside.push_back(run(passage, vehicle, unknowns, there, config, more_rounds, &here));
        }
        // The point again after as many rounds, so that only the unknowns differ.
        const auto same = run(passage, vehicle, unknowns, at, config, more_rounds, &here);
        const auto slope = slope_at(same, beside, unknowns);
        left = (slope.information + prior).inverse();
        iri = slope.iri;
        Eigen::VectorXd by = left * (slope.gradient - prior * (at - unknowns.expected));
        const double bold = (by.array() / unknowns.prior_sd.array()).abs().maxCoeff();
        at += by * std::min(1.0, boldest / std::max(bold, 1e-9));
        at[0] = std::max(at[0], 0.0);
        here = same;
    }
    TunedCar tuned{
        .vehicle = moved(vehicle, unknowns, at), .friction_n = at[0], .uncertainty = {}};
    tuned.friction_sd_n = std::sqrt(left(0, 0));
    for (std::size_t i = 0; i < unknowns.moved.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i) + 1;
        tuned.uncertainty[unknowns.moved[i]->name] = std::sqrt(left(k, k));
    }
    tuned.iri_sd = std::sqrt(iri.dot(left * iri));
    return tuned;
}

} // namespace macadam
