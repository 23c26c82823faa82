#pragma once

#include "storage/trips/detection/detected_channel.hpp"
#include "storage/trips/detection/log_table.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Accelerations and angular rates of a log.
struct DetectedInertia {
    std::vector<DetectedChannel> channels{};
    bool has_gravity = true; ///< of the accelerations
    bool of_device = false;  ///< in the axes of the device, which may be mounted anyhow
    std::string gravity{};   ///< for people: "gravity 9.79 m/s2, included"; "": no acceleration
};

/// Finds the accelerations and angular rates. Units follow from names and from gravity: the mean
/// acceleration of a drive is 9.81 m/s2, 1 g or 1000 mg, and 0 if the logger has removed it.
///
/// \param is_moving  whether the car is known to move: rad/s of a drive are as small as deg/s of a
///                   parked car.
DetectedInertia detect_inertia(const LogTable& table, bool is_moving);

} // namespace macadam
