#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace macadam {

// Interface between storage/trips/rawlog/rawlog_reader.cpp, rawlog_writer.cpp and the plug-in
// macadam_rawlog, which converts the bytes of MRPT objects into values and back. Unknown values are
// NaN.

struct RawlogImu {
    std::array<double, 3> acc_mps2;             ///< IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC
    std::array<double, 3> gyro_radps;           ///< about x, y, z: IMU_WX, IMU_WY, IMU_WZ
    std::array<double, 3> roll_pitch_yaw_deg{}; ///< orientation of the sensor on the vehicle
    friend bool operator==(const RawlogImu&, const RawlogImu&) = default;
};

/// Position fix from the NMEA messages GGA and RMC.
struct RawlogFix {
    double lat_deg;
    double lon_deg;
    double speed_mps;
    double course_deg;
    double hdop;
    double day_time_s; ///< UTC, since midnight, as stated by the receiver
    int quality;       ///< GGA code: 0 none, 1 single, 2 differential, 4 RTK, 5 float RTK
    friend bool operator==(const RawlogFix&, const RawlogFix&) = default;
};

struct RawlogOdometry {
    double x_m;
    double y_m;
    double heading_rad;
    double speed_mps; ///< forward; NaN: only the pose is known
    friend bool operator==(const RawlogOdometry&, const RawlogOdometry&) = default;
};

struct RawlogComment {
    std::string text;
    friend bool operator==(const RawlogComment&, const RawlogComment&) = default;
};

struct RawlogObservation {
    std::optional<std::int64_t> utc_ticks; ///< 100 ns since 1970; from 1900 to 2500
    std::string label;                     ///< label of the sensor
    std::variant<RawlogImu, RawlogFix, RawlogOdometry, RawlogComment> what;
};

inline constexpr std::int64_t rawlog_ticks_per_s = 10'000'000;

/// Decodes an object.
///
/// \param object  complete object, with the size from rawlog_size
///                (storage/trips/rawlog/rawlog_layout.hpp).
/// \throws InputError  with MRPT's message, if MRPT cannot read it.
using RawlogDecode = void(std::string_view object,
                          const std::function<void(RawlogObservation)>& take);
inline constexpr const char* rawlog_decode_name = "macadam_rawlog_decode";

using RawlogEncode = void(const RawlogObservation& observation,
                          const std::function<void(std::string_view)>& put);
inline constexpr const char* rawlog_encode_name = "macadam_rawlog_encode";

} // namespace macadam
