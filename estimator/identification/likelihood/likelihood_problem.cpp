#include "estimator/identification/likelihood/likelihood_problem.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr double taper_s = 1;
// Steps of finite differences, of a parameter and of the stations. They are small, since a common
// scale of masses, springs, dampers and friction must leave the readings exactly as they are.
constexpr double difference = 1e-4;
constexpr double shift_difference_m = 1e-3;
constexpr double shift_rise_sd_m = 0.5; // from knot to knot: 1 % of the travel
constexpr double shift_sd_m = 3;        // of the first knot

} // namespace

ReadingsWindow::ReadingsWindow(const ProfileDrive& drive, double run_in_s) {
    first_ = static_cast<Eigen::Index>(std::ceil(run_in_s / drive.step_s));
    const auto samples = static_cast<Eigen::Index>(drive.station_m.size()) - first_;
    rows_ = samples - samples % 64; // the Fourier transform of large primes is slow
    taper_ = Eigen::VectorXd::Ones(rows_);
    const auto ramp = static_cast<Eigen::Index>(taper_s / drive.step_s);
    for (Eigen::Index i = 0; i < ramp; ++i) {
        const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(ramp);
        taper_[i] = taper_[rows_ - 1 - i] = (1 - std::cos(std::numbers::pi * part)) / 2;
    }
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if (!drive.felt[channel].empty()) {
            channels_.push_back(channel);
        }
    }
}

Eigen::MatrixXd ReadingsWindow::operator()(const Readings& readings) const {
    Eigen::MatrixXd out(rows_, static_cast<Eigen::Index>(channels_.size()));
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        const auto& values = readings[channels_[i]];
        out.col(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::VectorXd>{values.data() + first_, rows_};
    }
    out.rowwise() -= out.colwise().mean();
    return taper_.asDiagonal() * out;
}

LikelihoodProblem::LikelihoodProblem(const ProfileDrive& drive,
                                     const Vehicle& vehicle,
                                     const LikelihoodFitConfig& config)
    : drive_{drive}, expected_{expected_car(vehicle)},
      parameters_{parameters_of(vehicle, !drive.felt[1].empty() || !drive.felt[2].empty())},
      knots_{knots_along(drive.station_m)}, window_{drive, config.run_in_s}, measured_{window_(
                                                                                 drive.felt)} {
    const auto cars = static_cast<Eigen::Index>(parameters_.size());
    prior_ = Eigen::MatrixXd::Zero(size(), size());
    for (Eigen::Index i = 0; i < cars; ++i) {
        prior_(i, i) = std::pow(parameters_[static_cast<std::size_t>(i)].prior_sd, -2);
    }
    prior_(cars, cars) = std::pow(shift_sd_m, -2);
    const double rise = std::pow(shift_rise_sd_m, -2);
    for (Eigen::Index i = cars; i + 1 < size(); ++i) {
        prior_(i, i) += rise;
        prior_(i + 1, i + 1) += rise;
        prior_(i, i + 1) -= rise;
        prior_(i + 1, i) -= rise;
    }
}

Eigen::VectorXd LikelihoodProblem::start() const {
    Eigen::VectorXd by = Eigen::VectorXd::Zero(size());
    const auto modelled = readings(by, 0);
    const auto shift_m =
        correlated_shifts(knots_, drive_.station_m, drive_.felt[0], modelled[0], drive_.step_s);
    std::ranges::copy(shift_m, by.data() + parameters_.size());
    return by;
}

void LikelihoodProblem::slopes(const Eigen::VectorXd& by,
                               const Eigen::MatrixXd& here,
                               const TakeSlope& take) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        Eigen::VectorXd beside = by;
        const auto unknown = static_cast<Eigen::Index>(i);
        beside[unknown] += difference;
        take(unknown, (modelled(beside) - here) / difference);
    }
    const Eigen::MatrixXd shifted =
        (window_(readings(by, shift_difference_m)) - here) / shift_difference_m;
    for (std::size_t knot = 0; knot < knots_.count; ++knot) {
        Eigen::VectorXd share(window_.rows());
        for (Eigen::Index k = 0; k < share.size(); ++k) {
            share[k] = share_of(
                knots_, knot, drive_.station_m[window_.first() + static_cast<std::size_t>(k)]);
        }
        take(static_cast<Eigen::Index>(parameters_.size() + knot), share.asDiagonal() * shifted);
    }
}

Readings LikelihoodProblem::readings(const Eigen::VectorXd& by, double further_m) const {
    auto shift_m = shifts_at(knots_, shifts(by), drive_.station_m);
    std::ranges::for_each(shift_m, [=](double& shift) { shift += further_m; });
    return simulated_readings(drive_, car(by), expected_.vehicle.gain, shift_m);
}

} // namespace macadam
