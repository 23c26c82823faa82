#pragma once

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
struct Readings {
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

/// How a car or a pass that is off is told from one that is not.
struct TailModel {
    double dof = 4;        ///< of Student's t
    double scatter_sd = 0; ///< of the readings, whatever they claim: a car is judged by it where it
                           ///< is less than the car's own
};

/// How far cars and readings are believed: what their variance was divided by, above 0 to 1.
struct Trust {
    Eigen::VectorXd of_reading;
    Eigen::VectorXd of_car;
};

/// A mean fitted to readings that are trusted so far.
struct MeanFit {
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd inverse; ///< of the normal equations' matrix
};

/// By generalised least squares. \param trust  of no more than there are readings and cars.
MeanFit fit_mean(const Readings& readings, const MeanModel& mean, const Trust& trust);

struct RobustFit {
    MeanFit fit;
    Trust trust;
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
RobustFit fit_robustly(const Readings& readings,
                       const MeanModel& mean,
                       const TailModel& tail,
                       const Eigen::VectorXd& start);

/// How much of each reading is in a coefficient of their fit, which is the sum of influence times
/// reading.
Eigen::VectorXd influence_on(const Readings& readings,
                             const MeanModel& mean,
                             const Trust& trust,
                             const MeanFit& fit,
                             Eigen::Index coefficient);

/// Of what is that sum, by the sds that the readings claim.
double variance_of(const Readings& readings, const Eigen::VectorXd& influence);

/// By the inverse of the readings' covariance as far as they are trusted.
Eigen::VectorXd
without_errors(const Readings& readings, const Trust& trust, Eigen::VectorXd column);

/// All trusted alike.
Trust full_trust(const Readings& readings);

} // namespace macadam
