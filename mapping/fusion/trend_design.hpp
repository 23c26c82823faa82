#pragma once

#include "mapping/fusion/roughness_time_series.hpp"

#include <limits>
#include <span>

namespace macadam {

/// Ages of readings, in years before the newest; NaN = undated.
struct Ages {
    std::vector<double> years;
    std::int64_t newest_ms; ///< 0 if all are undated
    double span_years;      ///< from the oldest to the newest
};
Ages ages_of(const std::vector<std::optional<std::int64_t>>& utc_ms);

/// Columns of the coefficients; the level is the first.
inline constexpr Eigen::Index level_column = 0;
inline constexpr Eigen::Index slope_column = 1; ///< per year, if has_slope

bool has_slope(const Ages& ages);

/// Builds the design matrix and the prior of the coefficients.
///
/// \param step_years  ages of steps: older readings lie before them. Their columns are the last.
MeanModel mean_model(const Ages& ages,
                     double level_um,
                     const ChangeModel& change,
                     std::span<const double> step_years);

/// Returns the column of a step: -1 before it. Undated readings take the share of dated readings
/// before it.
Eigen::VectorXd step_column(const Ages& ages, double step_years);

} // namespace macadam
