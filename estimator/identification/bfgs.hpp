#pragma once

#include <Eigen/Core>

#include <functional>

namespace macadam {

struct Minimum {
    Eigen::VectorXd at;
    double value;
};

/// Finds a local minimum of a smooth function of a few variables, downhill from `start`:
/// quasi-Newton (limited-memory BFGS) with central differences for the gradient.
///
/// \param function  its variables and its value should be of order 1, with similar sensitivities:
///                  differences are taken over 1e-5, and the search ends after two steps that
///                  reduce the value by less than 1e-9.
///
/// Source: J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd ed. (2006), chapters 3, 7 and 8.
Minimum minimise_bfgs(const Eigen::VectorXd& start,
                      const std::function<double(const Eigen::VectorXd&)>& function);

} // namespace macadam
