#pragma once

#include "estimator/identification/likelihood/car_parameters.hpp"
#include "estimator/identification/likelihood/likelihood_fit.hpp"
#include "estimator/identification/likelihood/profile_drive.hpp"
#include "estimator/identification/likelihood/station_shift.hpp"

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// Readings of all channels as columns, without the run-in and tapered at both ends.
class ReadingsWindow {
public:
    ReadingsWindow(const ProfileDrive& drive, double run_in_s);

    Eigen::MatrixXd operator()(const Readings& readings) const;

    Eigen::Index rows() const { return rows_; }
    std::size_t first() const { return static_cast<std::size_t>(first_); }
    const std::vector<std::size_t>& channels() const { return channels_; }

private:
    Eigen::Index first_, rows_;
    Eigen::VectorXd taper_;
    std::vector<std::size_t> channels_;
};

/// Least-squares problem of a drive over a known profile. The unknowns are the parameters of the
/// car, then the corrections of the stations; zero is the expected car at the stated stations.
class LikelihoodProblem {
public:
    LikelihoodProblem(const ProfileDrive& drive,
                      const Vehicle& vehicle,
                      const LikelihoodFitConfig& config);

    Eigen::Index size() const {
        return static_cast<Eigen::Index>(parameters_.size() + knots_.count);
    }
    const std::vector<CarParameter>& parameters() const { return parameters_; }
    const FittedCar& expected() const { return expected_; }
    const Eigen::MatrixXd& prior() const { return prior_; } ///< information matrix of the unknowns
    const Eigen::MatrixXd& measured() const { return measured_; }
    const ReadingsWindow& window() const { return window_; }
    double step_s() const { return drive_.step_s; }

    FittedCar car(const Eigen::VectorXd& by) const { return moved(expected_, parameters_, by); }

    /// Returns the corrections among the unknowns, m.
    std::span<const double> shifts(const Eigen::VectorXd& by) const {
        return {by.data() + parameters_.size(), knots_.count};
    }

    /// Returns the start: the expected car, at stations that match the measured readings.
    Eigen::VectorXd start() const;

    Eigen::MatrixXd modelled(const Eigen::VectorXd& by) const { return window_(readings(by, 0)); }

    using TakeSlope = std::function<void(Eigen::Index unknown, const Eigen::MatrixXd& slope)>;

    /// Passes on the derivative of the modelled readings by each unknown, one at a time, so that
    /// only the whitened ones are kept: all together take hundreds of megabytes. The derivative by
    /// a knot is the one by a shift of the whole drive, times the share of the knot: a car forgets
    /// within a fraction of the distance between knots.
    void
    slopes(const Eigen::VectorXd& by, const Eigen::MatrixXd& here, const TakeSlope& take) const;

private:
    Readings readings(const Eigen::VectorXd& by, double further_m) const;

    const ProfileDrive& drive_;
    FittedCar expected_;
    std::vector<CarParameter> parameters_;
    ShiftKnots knots_;
    ReadingsWindow window_;
    Eigen::MatrixXd measured_;
    Eigen::MatrixXd prior_;
};

} // namespace macadam
