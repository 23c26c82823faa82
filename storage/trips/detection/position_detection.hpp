#pragma once

#include "storage/trips/detection/time_detection.hpp"

#include <vector>

namespace macadam {

/// Positions, speeds, courses and accuracies of a log.
struct DetectedPositions {
    std::vector<DetectedChannel> channels{};
    bool speed_agrees = false;      ///< with the way between positions, which confirms the time
    bool speed_contradicts = false; ///< then time, positions or speed are wrong
    bool is_moving = false;         ///< for at least half of the time
};

/// Finds positions, speeds, courses and accuracies. Speeds and courses are compared with the chords
/// between positions. They also tell latitude from longitude where the names of the two are
/// exchanged.
///
/// \param time  null if the log has none.
DetectedPositions detect_positions(const LogTable& table, const DetectedTime* time);

} // namespace macadam
