#pragma once

#include "mapping/fusion/fusion_config.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace macadam {

/// Readings x of one quantity in a linear mixed model, in which each car has an error common to all
/// its passes, each trip one common to that trip, and each reading a residual:
///     x = columns * coefficients + car_sd * car + trip_sd * trip + rest_sd * rest
/// Readings of a car are consecutive, and within them those of a trip.
struct FusionObservations {
    struct Block {
        Eigen::Index first, count;
    };
    Eigen::VectorXd values;
    Eigen::VectorXd car_sd;
    Eigen::VectorXd rest_sd; ///< > 0
    double trip_sd;
    std::vector<Block> cars;
    std::vector<Block> trips; ///< readings outside all trips have no trip error

    /// Error common to all cars, at one standard deviation, where other readings (0) separate it
    /// from the road; as many as values, or empty: not separable.
    Eigen::VectorXd common_sd{};
};

/// Design matrix: one row per reading, one column per coefficient, stored row by row.
using MeanColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Mean model: the effects that all cars share.
struct MeanModel {
    MeanColumns columns;
    Eigen::VectorXd precisions; ///< 1 / variance about 0 of each coefficient; 0 = unconstrained
};

/// Robust weights of cars and readings: divisors of their variance, > 0 and <= 1.
struct RobustWeights {
    Eigen::VectorXd of_reading;
    Eigen::VectorXd of_car;
};

/// A mean fitted at given weights.
struct LeastSquaresFit {
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd inverse; ///< of the matrix of the normal equations
};

/// Fits the mean by generalised least squares. \param trust  weights of the readings and cars.
LeastSquaresFit
fit_mean(const FusionObservations& readings, const MeanModel& mean, const RobustWeights& trust);

struct RobustFit {
    LeastSquaresFit fit;
    RobustWeights trust;
    double misfit; ///< -log of likelihood times prior at the mode, up to a constant that depends on
                   ///< readings and tail
};

/// Fits the mean with Student's t for cars and, within each car, for its readings, so that one
/// broken car among several hardly counts. Iteratively reweighted.
///
/// Source: K. L. Lange, R. J. A. Little and J. M. G. Taylor, "Robust statistical modeling using the
/// t distribution", Journal of the American Statistical Association 84 (1989), pp. 881-896.
///
/// \param start  approximate mean of each reading.
RobustFit fit_student_t(const FusionObservations& readings,
                        const MeanModel& mean,
                        const TailModel& tail,
                        const Eigen::VectorXd& start);

/// Returns the influence of each reading on a fitted coefficient, which is the sum of influence
/// times reading.
Eigen::VectorXd influence_on(const FusionObservations& readings,
                             const MeanModel& mean,
                             const RobustWeights& trust,
                             const LeastSquaresFit& fit,
                             Eigen::Index coefficient);

/// Returns the variance of that sum according to the sds that the readings state.
double variance_of(const FusionObservations& readings, const Eigen::VectorXd& influence);

/// Multiplies a column by the inverse of the readings' covariance at the given weights.
Eigen::VectorXd without_errors(const FusionObservations& readings,
                               const RobustWeights& trust,
                               Eigen::VectorXd column);

/// Returns weights of 1.
RobustWeights full_trust(const FusionObservations& readings);

} // namespace macadam
