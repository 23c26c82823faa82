#pragma once

#include "storage/tables/csv_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace macadam {

// Files by what they hold, as the two apps name them. phyphox: "Accelerometer" is with gravity;
// Sensor Logger: it is without.
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

/// Whether a file goes by one of these names, whatever its case.
template <std::size_t count>
bool is_one_of(std::string_view file, const std::string_view (&names)[count]) {
    return std::any_of(std::begin(names), std::end(names), [&](std::string_view name) {
        return fits(file, name);
    });
}

/// Whether a folder that holds a file of this name is an export of phyphox or Sensor Logger.
bool marks_export(std::string_view file);

/// Whether a file of an export, by its path within it, may be one that we read.
bool belongs_to_export(std::string_view file);

} // namespace macadam
