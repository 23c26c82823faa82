#pragma once

#include <Eigen/Core>

#include <functional>

namespace macadam {

struct Minimum {
    Eigen::VectorXd at;
    double value;
};

/// Where a smooth function of a few variables is least, downhill from `start`: quasi-Newton (BFGS,
/// its curvature kept by the last steps) with central differences for the gradient. It may be a
/// local one.
///
/// \param function  its variables should be about as sensitive as each other and of order 1, and
///                  so its value: differences are taken over 1e-5, and two steps that lower it by
///                  less than 1e-9 are the last.
///
/// Source: J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd ed. (2006), chapters 3, 7 and 8.
Minimum minimise_bfgs(const Eigen::VectorXd& start,
                      const std::function<double(const Eigen::VectorXd&)>& function);

} // namespace macadam
