#pragma once

#include "storage/trips/detection/position_detection.hpp"

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
DetectedInertia detect_inertia(const LogTable& table);

} // namespace macadam
