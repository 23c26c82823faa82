#pragma once

#include <Eigen/Core>

namespace macadam {

/// Linear system. Continuous: x' = a x + b u, y = c x. Discrete: x[k+1] = a x[k] + b u[k], y[k] = c
/// x[k].
template <int States, int Inputs, int Outputs>
struct LinearSystem {
    Eigen::Matrix<double, States, States> a;
    Eigen::Matrix<double, States, Inputs> b;
    Eigen::Matrix<double, Outputs, States> c;
};

/// Computes the exponential of a square matrix.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix);

/// Discretises the system with step `step_s`, exact for inputs that are constant within a step.
template <int States, int Inputs, int Outputs>
LinearSystem<States, Inputs, Outputs>
discretise(const LinearSystem<States, Inputs, Outputs>& system, double step_s) {
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(States + Inputs, States + Inputs);
    whole.template topLeftCorner<States, States>() = system.a * step_s;
    whole.template topRightCorner<States, Inputs>() = system.b * step_s;
    const Eigen::MatrixXd moved = exponential(whole);
    return {moved.template topLeftCorner<States, States>(),
            moved.template topRightCorner<States, Inputs>(),
            system.c};
}

} // namespace macadam
