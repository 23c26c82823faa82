#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace macadam {

// What storage/trips/rawlog/rawlog_reader.cpp and rawlog_writer.cpp ask of the plug-in
// macadam_rawlog: to turn the bytes of one MRPT object into values and back. Not known: NaN.

struct RawlogImu {
    std::array<double, 3> acc_mps2;             ///< IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC
    std::array<double, 3> gyro_radps;           ///< about x, y, z: IMU_WX, IMU_WY, IMU_WZ
    std::array<double, 3> roll_pitch_yaw_deg{}; ///< of the sensor on the vehicle
    friend bool operator==(const RawlogImu&, const RawlogImu&) = default;
};

/// Of the NMEA messages GGA and RMC.
struct RawlogFix {
    double lat_deg;
    double lon_deg;
    double speed_mps;
    double course_deg;
    double hdop;
    double day_time_s; ///< UTC, since midnight, as the receiver says
    int quality;       ///< as GGA counts: 0 none, 1 single, 2 differential, 4 RTK, 5 float RTK
    friend bool operator==(const RawlogFix&, const RawlogFix&) = default;
};

struct RawlogOdometry {
    double x_m;
    double y_m;
    double heading_rad;
    double speed_mps; ///< ahead; NaN: only the pose is known
    friend bool operator==(const RawlogOdometry&, const RawlogOdometry&) = default;
};

struct RawlogComment {
    std::string text;
    friend bool operator==(const RawlogComment&, const RawlogComment&) = default;
};

struct RawlogObservation {
    std::optional<std::int64_t> utc_ticks; ///< of 100 ns since 1970; from 1900 to 2500
    std::string label;                     ///< of the sensor
    std::variant<RawlogImu, RawlogFix, RawlogOdometry, RawlogComment> what;
};

inline constexpr std::int64_t rawlog_ticks_per_s = 10'000'000;

/// `object` is the whole of one, as rawlog_size (storage/trips/rawlog/rawlog_layout.hpp) measures
/// it. \throws InputError  if MRPT cannot read it; the message is its complaint.
using RawlogDecode = void(std::string_view object,
                          const std::function<void(RawlogObservation)>& take);
inline constexpr const char* rawlog_decode_name = "macadam_rawlog_decode";

using RawlogEncode = void(const RawlogObservation& observation,
                          const std::function<void(std::string_view)>& put);
inline constexpr const char* rawlog_encode_name = "macadam_rawlog_encode";

} // namespace macadam
