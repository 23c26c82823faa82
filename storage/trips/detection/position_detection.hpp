#pragma once

#include "storage/trips/detection/time_detection.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Column that was read as a channel of the trip log.
struct DetectedChannel {
    std::string channel{}; ///< "acc_z_mps2"
    std::size_t column;    ///< number, from 1
    std::string unit{};    ///< word of mapping files; "": none
    double scale = 1;
    int sign = 1;
    bool minus_one_is_none = false;          ///< -1 stands for an unknown value
    std::optional<std::size_t> hemisphere{}; ///< number of its column
    Confidence confidence = Confidence::likely;
    std::string reason{}; ///< for people
};

/// Finds positions, speeds, courses and accuracies. Speeds and courses are compared with the way
/// from position to position.
///
/// \param time  null if the log has none.
std::vector<DetectedChannel> detect_positions(const LogTable& table, const DetectedTime* time);

} // namespace macadam
