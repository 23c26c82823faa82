#pragma once

#include "estimator/common/geo.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Readings of a three-axis sensor in order of time; x, y and z have the size of t_s. NaN means
/// that the axis was not sampled. Floats resolve a micro-g, and ten hours at 100 Hz must fit in
/// memory.
struct TriaxialSamples {
    std::vector<double> t_s; ///< seconds since the trip's t0, increasing
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
};

/// Readings of the wheels or the CAN bus; negative when reversing.
struct SpeedSamples {
    std::vector<double> t_s;
    std::vector<float> speed_mps;
};

/// Reading of a satellite receiver at one time. Unknown values are NaN.
struct GnssFix {
    double t_s;  ///< time stamp; the true time is gnss_latency_s earlier
    GeoPoint at; ///< antenna position
    float speed_mps;
    float course_deg; ///< clockwise from north
    float accuracy_m; ///< horizontal accuracy as stated by the receiver
};

enum class Frame : std::uint8_t {
    flu,    ///< x forward, y left, z up (ISO 8855): vehicle frame
    frd,    ///< x forward, y right, z down
    sensor, ///< the device's own axes; mounting angles rotate them to the vehicle's
};

/// Header of a log ("# key: value").
struct TripMeta {
    std::string trip_id;
    std::string vehicle_id;
    std::optional<double> t0_utc_s; ///< seconds since 1970-01-01T00:00:00Z; `std::nullopt`: undated
    Frame frame = Frame::flu;
    bool gravity_included = true;
    bool mount_auto = false;                            ///< mounting is estimated from the motion
    std::optional<std::array<double, 3>> mount_rpy_deg; ///< sensor to vehicle
    std::optional<std::array<double, 4>> mount_quat;    ///< w x y z, sensor to vehicle
    std::optional<std::array<double, 3>> acc_sensor_pos_m;   ///< behind the front axle, left, up
    std::optional<std::array<double, 3>> gnss_antenna_pos_m; ///< behind the front axle, left, up
    bool frame_stated = false;
    bool gnss_latency_stated = false;
    double gnss_latency_s = 0;
    double gnss_latency_sd_s = 0; ///< of an estimated latency; 0: not known
    double speed_latency_s = 0;
    std::optional<double> speed_scale;        ///< true speed = scale * logged speed
    std::map<std::string, std::string> other; ///< all other keys
};

/// Flags for the sensors in a row of the log.
namespace row_content {
inline constexpr std::uint8_t acc = 1;
inline constexpr std::uint8_t gyro = 2;
inline constexpr std::uint8_t speed = 4;
inline constexpr std::uint8_t fix = 8;
} // namespace row_content

/// Reason for which a row was rejected. `name_of` returns the names shown to users.
enum class RowReason : std::uint8_t {
    wrong_cell_count = 16,
    bad_number,
    out_of_range,
    no_time,
    no_sample,           ///< every cell but the time is empty
    time_not_increasing, ///< out of order with the other samples of its sensor
    unused_channel,      ///< its sensors are not needed by the method in use
    too_slow,
    short_stretch, ///< part without gaps that is too short for an estimate
    no_speed,      ///< vibration without a known speed at its time
    implausible,   ///< position or speed that contradicts its neighbours
    inaccurate,    ///< position with a poor accuracy stated by the receiver
    repeated_fix,  ///< repetition of the previous fix, as loggers write on every fast row
    merged,        ///< added to another row's reading, as gravity is to acceleration
    trimmed,       ///< too near to the start or end of the trip, removed for privacy
    sensor_moved,  ///< sensor orientation differs from that of most of the trip
};
const char* name_of(RowReason reason);

/// Returns the reason as rows and uses hold it.
constexpr std::uint8_t code(RowReason reason) {
    return static_cast<std::uint8_t>(reason);
}

/// Recording of one car from start to stop, by sensor.
///
/// `rows` has one entry per data row of the log, in order: a sum of row_content flags for the
/// samples that the row contributed to the streams (the n-th row with a flag contributed that
/// stream's n-th sample), or a RowReason (>= 16) if it contributed none. Every row can therefore be
/// accounted for.
struct TripLog {
    TripMeta meta;
    std::string sha256;   ///< SHA-256 of the decompressed content, 64 lower-case hex digits
    TriaxialSamples acc;  ///< specific force, m/s2, in meta.frame
    TriaxialSamples gyro; ///< rad/s, in meta.frame
    SpeedSamples speed;
    std::vector<GnssFix> fixes;
    std::vector<std::uint8_t> rows;
    std::vector<std::string> unknown_columns;
};

/// Use of the samples of one stream: for each 0 if it was used, otherwise the RowReason.
using SampleUse = std::vector<std::uint8_t>;

/// Use of a trip's samples in an estimate, by stream.
struct RowAudit {
    SampleUse acc;
    SampleUse gyro;
    SampleUse speed;
    SampleUse fixes;
};

struct RowCount {
    std::size_t read = 0;
    std::size_t used = 0;
    std::size_t rejected = 0; ///< read = used + rejected, always
    std::map<std::string, std::size_t> reasons;
    friend bool operator==(const RowCount&, const RowCount&) = default;
};

std::vector<double> times_of(const std::vector<GnssFix>& fixes);

/// Counts used and rejected rows. A row is used if at least one of its samples was; otherwise it is
/// rejected once, with the first reason in the order acc, gyro, speed, fix.
RowCount account(const TripLog& trip, const RowAudit& use);

} // namespace macadam
