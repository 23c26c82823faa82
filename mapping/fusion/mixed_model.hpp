#pragma once

#include "mapping/fusion/fusion_config.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace macadam {

/// Readings x of one thing, in which what a car reads wrong is the same in all its passes, what a
/// trip reads wrong in all of that trip, and a rest in none:
///
///     x = columns * coefficients + car_sd * car + trip_sd * trip + rest_sd * rest
///
/// Readings of a car stand one after the other, and within them those of a trip.
struct FusionObservations {
    struct Block {
        Eigen::Index first, count;
    };
    Eigen::VectorXd values;
    Eigen::VectorXd car_sd;
    Eigen::VectorXd rest_sd; ///< > 0
    double trip_sd;
    std::vector<Block> cars;
    std::vector<Block> trips; ///< readings in none have no part of a trip

    /// What all cars read wrong alike, at one standard deviation, where other readings (0) tell it
    /// apart from the road; as many as values, or none: not told apart.
    Eigen::VectorXd common_sd{};
};

/// One row for each reading, one column for each coefficient; a reading's values stand together.
using MeanColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What changes the readings alike for all cars.
struct MeanModel {
    MeanColumns columns;
    Eigen::VectorXd precisions; ///< 1 / variance about 0 of each coefficient; 0 = anything
};

/// How far cars and readings are believed: what their variance was divided by, above 0 to 1.
struct RobustWeights {
    Eigen::VectorXd of_reading;
    Eigen::VectorXd of_car;
};

/// A mean fitted to readings that are trusted so far.
struct LeastSquaresFit {
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd inverse; ///< of the normal equations' matrix
};

/// By generalised least squares. \param trust  of no more than there are readings and cars.
LeastSquaresFit
fit_mean(const FusionObservations& readings, const MeanModel& mean, const RobustWeights& trust);

struct RobustFit {
    LeastSquaresFit fit;
    RobustWeights trust;
    double misfit; ///< -log of likelihood and prior at their mode, but for a constant of readings
                   ///< and tail
};

/// Cars have Student's t, and within each car its readings, so that one broken car among several
/// hardly counts; found by weighing anew.
///
/// Source: K. L. Lange, R. J. A. Little and J. M. G. Taylor, "Robust statistical modeling using the
/// t distribution", Journal of the American Statistical Association 84 (1989), pp. 881-896.
///
/// \param start  for each reading, about what the mean is there.
RobustFit fit_student_t(const FusionObservations& readings,
                        const MeanModel& mean,
                        const TailModel& tail,
                        const Eigen::VectorXd& start);

/// How much of each reading is in a coefficient of their fit, which is the sum of influence times
/// reading.
Eigen::VectorXd influence_on(const FusionObservations& readings,
                             const MeanModel& mean,
                             const RobustWeights& trust,
                             const LeastSquaresFit& fit,
                             Eigen::Index coefficient);

/// Of what is that sum, by the sds that the readings claim.
double variance_of(const FusionObservations& readings, const Eigen::VectorXd& influence);

/// By the inverse of the readings' covariance as far as they are trusted.
Eigen::VectorXd without_errors(const FusionObservations& readings,
                               const RobustWeights& trust,
                               Eigen::VectorXd column);

/// All trusted alike.
RobustWeights full_trust(const FusionObservations& readings);

} // namespace macadam
