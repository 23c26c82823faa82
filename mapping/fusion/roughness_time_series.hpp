#pragma once

#include "mapping/fusion/fusion_config.hpp"
#include "mapping/fusion/mixed_model.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

struct Step {
    std::int64_t utc_ms; ///< of the first reading after the step
    double um;           ///< level after minus level before
};

struct Trend {
    double um_per_year;
    double sd_um_per_year;
};

/// Roughness of a road on the day of its newest reading, without the season.
struct RoughnessTrend {
    double um;
    Eigen::VectorXd influence;  ///< influence of each reading on `um`
    double change_variance_um2; ///< of `um`, from the uncertain change of the road
    RobustWeights trust;
    Eigen::VectorXd expected_um; ///< of each reading, on its own day
    std::optional<Trend> trend;  ///< `std::nullopt` if readings span no more than a year
    std::vector<Step> steps;     ///< in order of time
};

/// Fits a local level with trend, season and steps to readings with errors of car, trip and pass
/// (A. C. Harvey, "Forecasting, structural time series models and the Kalman filter", Cambridge
/// University Press 1989, section 2.3, its levels a random walk by months). Undated readings take
/// the mean design row of the dated ones.
///
/// \param utc_ms    of each reading; `std::nullopt`: undated.
/// \param level_um  approximate level of the readings, > 0; relative quantities refer to it.
RoughnessTrend roughness_level(const FusionObservations& readings,
                               const std::vector<std::optional<std::int64_t>>& utc_ms,
                               double level_um,
                               const TailModel& tail,
                               const ChangeModel& change);

} // namespace macadam
