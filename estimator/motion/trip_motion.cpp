#include "estimator/motion/trip_motion.hpp"

#include "estimator/motion/make_odometer.hpp"

#include <utility>

namespace macadam {

TripMotion motion_of(const TripLog& trip, const OdometerConfig& config) {
    auto [odometer, speed, fixes] = make_odometer(trip, config);
    auto mounting = estimate_mounting(trip, odometer);
    auto heading = make_heading(trip, odometer, mounting);
    return {std::move(odometer),
            std::move(mounting),
            std::move(heading),
            std::move(speed),
            std::move(fixes)};
}

} // namespace macadam
