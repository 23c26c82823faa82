#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace macadam {

/// Measurement that the name of a column suggests.
enum class Quantity : std::uint8_t {
    unknown,
    time, ///< of day, since a start, or with the date
    date,
    acceleration,
    linear_acceleration, ///< without gravity
    gravity,
    angular_rate,
    angular_rate_or_g, ///< named gx, gy, gz
    latitude,
    longitude,
    gnss_speed,
    vehicle_speed,
    speed, ///< of either
    course,
    accuracy, ///< horizontal
};

/// Axes that a name states: of the device (x, y, z), or of the vehicle (longitudinal, lateral,
/// vertical, or roll, pitch, yaw).
struct NamedAxis {
    int number = 0; ///< 1 to 3; 0: none
    bool of_vehicle = false;
};

/// Reading of a column's name.
struct NamedColumn {
    Quantity quantity = Quantity::unknown;
    NamedAxis axis{};
    std::string unit{};    ///< word of mapping files; "": not named
    std::string family{};  ///< the name without its axis; equal for the axes of a sensor
    bool is_apple = false; ///< of iOS, where all accelerations have the opposite sign
};

/// Reads a name such as "ACCELEROMETER X (m/s²)", "GPS_Speed[km/h]", "Geschwindigkeit" or "az".
///
/// \param unit  cell of a row of units below the name; "": none.
NamedColumn read_column_name(std::string_view name, std::string_view unit = "");

} // namespace macadam
