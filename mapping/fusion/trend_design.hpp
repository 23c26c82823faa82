#pragma once

#include "mapping/fusion/roughness_time_series.hpp"

#include <limits>
#include <span>

namespace macadam {

/// When readings were taken, in years before the newest; NaN = undated.
struct Ages {
    std::vector<double> years;
    std::int64_t newest_ms; ///< 0 where all are undated
    double span_years;      ///< from the oldest to the newest
};
Ages ages_of(const std::vector<std::optional<std::int64_t>>& utc_ms);

/// Places of the coefficients that a change has; the level is the first.
inline constexpr Eigen::Index level_column = 0;
inline constexpr Eigen::Index slope_column = 1; ///< per year, if the span has_slope

bool has_slope(const Ages& ages);

/// \param step_years  ages of steps: what is older is before them. Their columns are the last.
MeanModel mean_model(const Ages& ages,
                     double level_um,
                     const ChangeModel& change,
                     std::span<const double> step_years);

/// The column of a step: -1 before it. Undated readings lie before it by the share of those that
/// do.
Eigen::VectorXd step_column(const Ages& ages, double step_years);

} // namespace macadam
