#pragma once

#include "storage/trips/detection/log_table.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Confidence in a reading of a column.
enum class Confidence : std::uint8_t {
    likely, ///< name or values suggest it
    sure,   ///< name and values agree, or the values allow one reading only
};

/// Time of a log: its columns and format in the words of mapping files.
struct DetectedTime {
    std::vector<std::size_t> columns{}; ///< numbers, from 1; date and time may be two
    std::string format{};               ///< "ms", "iso", ...
    bool since_1970 = false;
    bool has_date = false; ///< gives UTC
    Confidence confidence = Confidence::likely;
    std::string reason{};      ///< for people: "steps of 0.01 s"
    std::vector<double> t_s{}; ///< for each row, from any origin; NaN: none
};

/// Finds the time of a log; `std::nullopt` if no column increases like one.
std::optional<DetectedTime> detect_time(const LogTable& table);

} // namespace macadam
