#pragma once

#include "mapping/fusion/fusion_config.hpp"
#include "mapping/fusion/mixed_model.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

struct Step {
    std::int64_t utc_ms; ///< of the first reading after it
    double um;           ///< the level after less that before
};

struct Trend {
    double um_per_year;
    double sd_um_per_year;
};

/// A road's roughness on the day of its newest reading, seasons aside.
struct RoughnessTrend {
    double um;
    Eigen::VectorXd influence;  ///< of each reading on it
    double change_variance_um2; ///< of it: what is not known of how the road changed
    RobustWeights trust;
    Eigen::VectorXd expected_um; ///< of each reading, as its day was
    std::optional<Trend> trend;  ///< nothing where readings span no more than a year
    std::vector<Step> steps;     ///< by time
};

/// A local level with trend, season and steps, and readings with parts of car, trip and pass
/// (A. C. Harvey, "Forecasting, structural time series models and the Kalman filter", Cambridge
/// University Press 1989, section 2.3, its levels a random walk by months). Readings without a date
/// are taken for the middle of those with one.
///
/// \param utc_ms    of each reading; nothing: undated.
/// \param level_um  about what the readings are, > 0: what is relative is relative to it.
RoughnessTrend roughness_level(const FusionObservations& readings,
                               const std::vector<std::optional<std::int64_t>>& utc_ms,
                               double level_um,
                               const TailModel& tail,
                               const ChangeModel& change);

} // namespace macadam
