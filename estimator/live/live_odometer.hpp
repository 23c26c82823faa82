#pragma once

#include "estimator/motion/odometer.hpp"

#include <optional>

namespace macadam {

/// Travel of a trip in progress. Everything older than `settled_s` is final; the rest is recomputed
/// at each update, and after the last speed reading the car is assumed to keep that speed.
struct LiveOdometer {
    Odometer::Knots settled;          ///< the last ones, for as long as they may be needed
    std::optional<Odometer> odometer; ///< these and the data since; `std::nullopt`: no speed yet
};

struct LiveRulerConfig {
    OdometerConfig odometer;
    double settled_s = 3; ///< after this time, speeds contradicted by their neighbours are known
    double keep_s = 90;
};

/// \param motion  speeds and fixes, from before the last settled time until now.
/// \param now_s   the latest time of any sensor; with `over` the odometer ends there instead of
///                extrapolating.
LiveOdometer measured_on(LiveOdometer ruler,
                         const TripLog& motion,
                         double now_s,
                         const LiveRulerConfig& config,
                         bool over = false);

} // namespace macadam
