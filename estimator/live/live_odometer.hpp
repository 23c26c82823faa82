#pragma once

#include "estimator/motion/odometer.hpp"

#include <optional>

namespace macadam {

/// Travel while the trip goes on. What lies `settled_s` behind never changes; the rest is measured
/// again each time, and beyond the last speed the car is taken to go on as fast as then.
struct LiveOdometer {
    Odometer::Knots settled;          ///< the last of them, as long as they may be asked for
    std::optional<Odometer> odometer; ///< these and what followed so far; nothing: no speed yet
};

struct LiveRulerConfig {
    OdometerConfig odometer;
    double settled_s = 3; ///< by then speeds that their neighbours contradict are known
    double keep_s = 90;
};

/// \param motion  speeds and fixes, from before the last settled time until now.
/// \param now_s   the latest time of any sensor; ends, rather than goes on, there if `over`
LiveOdometer measured_on(LiveOdometer ruler,
                         const TripLog& motion,
                         double now_s,
                         const LiveRulerConfig& config,
                         bool over = false);

} // namespace macadam
