#pragma once

#include "estimator/vehicle/linear_system.hpp"

#include <Eigen/Cholesky>

namespace macadam {

/// Kalman filter for an unknown input, as in the paper: estimates the road under a car from the
/// car's response.
///
/// The input is white noise of covariance q * I beside measurement noise of covariance I, and the
/// state x[k] is estimated; the input that best explains the step from x[k|k] to x[k+1|k+1] is
/// u[k|k+1] = q G^T P[k+1|k]^-1 (x[k+1|k+1] - F x[k|k]). Since the step is K e with K = P H^T S^-1,
/// this is q (H G)^T S^-1 e: no matrix of the state's size is inverted, and P may be singular.
///
/// The covariance does not depend on the measurements. It is propagated until it and the gain have
/// settled, and is constant from then on.
template <int States, int Inputs, int Outputs>
class UnknownInputFilter {
public:
    using Input = Eigen::Vector<double, Inputs>;
    using Output = Eigen::Vector<double, Outputs>;

    /// \param system    discrete, as returned by `discretise`.
    /// \param q_over_r  ratio of the variance of the road to that of the sensor noise.
    UnknownInputFilter(const LinearSystem<States, Inputs, Outputs>& system, double q_over_r)
        : system_{system}, q_{q_over_r} {}

    /// Returns the input held from the previous measurement until this one.
    Input push(const Output& measured) {
        if (!settled_) {
            update_gain();
        }
        const State predicted = system_.a * state_;
        const Output error = measured - system_.c * predicted;
        state_ = predicted + gain_ * error;
        return input_gain_ * error;
    }

    bool settled() const { return settled_; }

private:
    using State = Eigen::Vector<double, States>;
    using Square = Eigen::Matrix<double, States, States>;

    // Below these changes per step, the remaining relative error of the gain is about 1e-6: the
    // slowest mode, drift, takes some 1e5 steps. The gain alone is not sufficient: it can stand
    // still before the covariance has forgotten the drift.
    static constexpr double settled_gain = 1e-11;
    static constexpr double settled_covariance = 1e-7;

    // Variance of the initial state, beside a measurement noise of 1: the state is unknown. Started
    // at rest, the filter would be the plain inverse of the car, which is unstable in steps of 20
    // ms.
    static constexpr double unknown = 1e4;

    void update_gain() {
        const auto& [f, g, h] = system_;
        const Square predicted = f * covariance_ * f.transpose() + q_ * g * g.transpose();
        const Eigen::Matrix<double, Outputs, Outputs> s =
            h * predicted * h.transpose() + Eigen::Matrix<double, Outputs, Outputs>::Identity();
        const auto solver = s.llt();
        const Eigen::Matrix<double, States, Outputs> gain = solver.solve(h * predicted).transpose();
        input_gain_ = q_ * solver.solve(h * g).transpose();
        // Joseph form: with q / r of 1e9 the short form loses the covariance's sign.
        const Square rest = Square::Identity() - gain * h;
        const Square before = covariance_;
        covariance_ = rest * predicted * rest.transpose() + gain * gain.transpose();
        settled_ = (gain - gain_).norm() <= settled_gain * gain.norm() &&
                   (covariance_ - before).norm() <= settled_covariance * covariance_.norm();
        gain_ = gain;
    }

    LinearSystem<States, Inputs, Outputs> system_;
    double q_;
    State state_ = State::Zero();
    Square covariance_ = unknown * Square::Identity();
    Eigen::Matrix<double, States, Outputs> gain_ = Eigen::Matrix<double, States, Outputs>::Zero();
    Eigen::Matrix<double, Inputs, Outputs> input_gain_;
    bool settled_ = false;
};

} // namespace macadam
