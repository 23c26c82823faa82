#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace macadam {

/// Value of a series. Only the ratios of the variances count.
struct SeriesPoint {
    double value;
    double variance; ///< > 0
};

/// Shift of the mean of a series.
struct LevelShift {
    std::size_t first; ///< index of the first value after it
    double size;       ///< mean after minus mean before
    double sd;         ///< of the size

    /// Upper bound of the probability that a series without a shift has one that looks as
    /// significant anywhere.
    double p_value;
};

/// Values required on either side of a shift.
inline constexpr std::size_t min_beside_shift = 3;

/// Finds the likeliest shift of the mean of a series of normal values whose common variance factor
/// is unknown: the largest likelihood ratio, which is the largest t statistic of all splits, or of
/// all intervals against the values outside (a shift that was taken back; the shift returned is its
/// beginning). The p-value is Bonferroni's over the splits and intervals. Values that resemble
/// their neighbours, as those of a drifting series do, count as fewer: the sd grows by the factor
/// for first-order autocorrelation.
///
/// Source: K. J. Worsley, "On the likelihood ratio test for a shift in location of normal
/// populations", Journal of the American Statistical Association 74 (1979), pp. 365-367; B. Levin
/// and J. Kline, "The CUSUM test of homogeneity", Statistics in Medicine 4 (1985), pp. 469-488; G.
/// V. Bayley and J. M. Hammersley, "The effective number of independent observations in an
/// autocorrelated time series", Supplement to the JRSS 8 (1946), pp. 184-197.
///
/// \returns std::nullopt  if there are fewer than twice min_beside_shift values, or all are equal.
std::optional<LevelShift> find_level_shift(std::span<const SeriesPoint> series);

/// Returns the probability that the absolute value of a Student t variate exceeds |t|.
/// \param degrees_of_freedom  > 0
double student_t_tail(double t, double degrees_of_freedom);

} // namespace macadam
