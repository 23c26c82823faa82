#pragma once

#include "storage/trips/detection/detected_channel.hpp"
#include "storage/trips/detection/log_table.hpp"

#include <vector>

namespace macadam {

/// Latitude or longitude: how the numbers of a column become degrees.
struct Coordinate {
    DetectedChannel channel{};
    std::vector<double> deg{}; ///< by row; NaN: no position
};

/// Position of each row.
struct Coordinates {
    Coordinate latitude{};
    Coordinate longitude{};
};

/// Reads two columns as degrees, ddmm.mmmm, minutes of VBOX files, or whole degrees times 1e7, 1e6
/// or 1e5. Zeros are no position.
Coordinates read_coordinates(const LogTable& table, const LogColumn& lat, const LogColumn& lon);

} // namespace macadam
