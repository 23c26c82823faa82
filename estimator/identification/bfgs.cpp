#include "estimator/identification/bfgs.hpp"

#include <LBFGS.h>

#include <limits>
#include <stdexcept>

namespace macadam {
namespace {

constexpr double difference = 1e-5;
constexpr int most_iterations = 100;
constexpr double enough = 1e-9;      // the search ends after two smaller reductions of the value
constexpr int remembered_steps = 12; // several times the variables: as good as the full matrix

Eigen::VectorXd gradient(const std::function<double(const Eigen::VectorXd&)>& function,
                         const Eigen::VectorXd& at) {
    Eigen::VectorXd slope(at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
        Eigen::VectorXd moved = at;
        moved[i] = at[i] + difference;
        const double above = function(moved);
        moved[i] = at[i] - difference;
        slope[i] = (above - function(moved)) / (2 * difference);
    }
    return slope;
}

LBFGSpp::LBFGSParam<double> settings() {
    LBFGSpp::LBFGSParam<double> settings;
    settings.m = remembered_steps;
    settings.epsilon = 1e-8;
    settings.epsilon_rel = 0;
    settings.past = 2;
    settings.delta = enough;
    settings.max_iterations = most_iterations;
    settings.linesearch = LBFGSpp::LBFGS_LINESEARCH_BACKTRACKING_STRONG_WOLFE;
    settings.max_linesearch = 15;
    settings.max_step = 10;
    return settings;
}

} // namespace

Minimum minimise_bfgs(const Eigen::VectorXd& start,
                      const std::function<double(const Eigen::VectorXd&)>& function) {
    Minimum best{.at = start, .value = std::numeric_limits<double>::infinity()};
    const auto with_gradient = [&](const Eigen::VectorXd& at, Eigen::VectorXd& slope) {
        const double value = function(at);
        slope = gradient(function, at);
        if (value < best.value) {
            best = {.at = at, .value = value};
        }
        return value;
    };
    const auto parameters = settings(); // the solver keeps a reference to it
    LBFGSpp::LBFGSSolver<double, LBFGSpp::LineSearchNocedalWright> solver{parameters};
    Eigen::VectorXd at = start;
    double value = 0;
    try {
        solver.minimize(with_gradient, at, value);
    } catch (const std::runtime_error&) {
        // The line search finds no lower value: the differences are dominated by rounding.
    } catch (const std::logic_error&) {
        // Likewise: the direction is no longer downhill.
    }
    return best;
}

} // namespace macadam
