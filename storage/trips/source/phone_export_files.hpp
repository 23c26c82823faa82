#pragma once

#include "storage/tables/csv_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace macadam {

// File names of the two apps by content. "Accelerometer" includes gravity in phyphox and excludes
// it in Sensor Logger.
inline constexpr std::string_view total_files[] = {"TotalAcceleration.csv"};
inline constexpr std::string_view acc_files[] = {"Accelerometer.csv", "Acceleration.csv"};
inline constexpr std::string_view linear_files[] = {"Linear Accelerometer.csv",
                                                    "Linear Acceleration.csv"};
inline constexpr std::string_view raw_files[] = {"AccelerometerUncalibrated.csv"};
inline constexpr std::string_view gravity_files[] = {"Gravity.csv"};
inline constexpr std::string_view gyro_files[] = {"Gyroscope.csv"};
inline constexpr std::string_view location_files[] = {"Location.csv"};
inline constexpr std::string_view time_file = "meta/time.csv";
inline constexpr std::string_view metadata_file = "Metadata.csv";

/// Tests whether a file has one of these names, ignoring case.
template <std::size_t count>
bool is_named_in(std::string_view file, const std::string_view (&names)[count]) {
    return std::any_of(std::begin(names), std::end(names), [&](std::string_view name) {
        return fits(file, name);
    });
}

/// Tests whether a file of this name marks its folder as an export of phyphox or Sensor Logger.
bool marks_export(std::string_view file);

/// Tests whether a file of an export, by its path within it, may be used.
bool belongs_to_export(std::string_view file);

} // namespace macadam
