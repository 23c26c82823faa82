#pragma once

#include "storage/trips/detection/detected_channel.hpp"
#include "storage/trips/detection/log_table.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Time of a log: its columns and format in the words of mapping files.
struct DetectedTime {
    std::vector<std::size_t> columns{}; ///< numbers, from 1; date and time may be two
    std::string format{};               ///< "ms", "iso", ...
    double scale = 1;                   ///< of a number: 0.1 and "ms" are steps of 0.1 ms
    bool is_guess = false;              ///< nothing but the size of the steps tells the unit
    bool since_1970 = false;
    bool has_date = false; ///< gives UTC
    Confidence confidence = Confidence::likely;
    double step_s = 0;         ///< median of a number
    std::string reason{};      ///< for people: "steps of 0.01 s"
    std::vector<double> t_s{}; ///< for each row, from any origin; NaN: none
};

/// Reads a count whose unit is a guess in each other unit, of which one may fit the other columns.
std::vector<DetectedTime> other_units_of(const DetectedTime& time);

/// Describes the unit or format: "ms", "0.1 ms", "iso".
std::string unit_words(const DetectedTime& time);

/// Finds the time of a log; `std::nullopt` if no column increases like one.
std::optional<DetectedTime> detect_time(const LogTable& table);

} // namespace macadam
