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

/// Readings of a three-axis sensor, in the order of their time: as many of each as of t_s.
/// NaN = that axis was not sampled. Floats hold a micro-g; ten hours at 100 Hz must fit in memory.
struct TriaxialSamples {
    std::vector<double> t_s; ///< since the trip's t0, rising
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
};

/// Readings of the wheels or the CAN bus; negative when reversing.
struct SpeedSamples {
    std::vector<double> t_s;
    std::vector<float> speed_mps;
};

/// What a satellite receiver said at one time. Not known: NaN.
struct GnssFix {
    double t_s;  ///< of the stamp; the truth is gnss_latency_s older
    GeoPoint at; ///< of the antenna
    float speed_mps;
    float course_deg; ///< clockwise from north
    float accuracy_m; ///< what the receiver says of its horizontal position
};

enum class Frame : std::uint8_t {
    flu,    ///< x forward, y left, z up (ISO 8855): the vehicle's
    frd,    ///< x forward, y right, z down
    sensor, ///< the device's own; mounting angles lead to the vehicle's
};

/// What the head of a log says ("# key: value").
struct TripMeta {
    std::string trip_id;
    std::string vehicle_id;
    std::optional<double> t0_utc_s; ///< seconds since 1970-01-01T00:00:00Z; nothing: undated
    Frame frame = Frame::flu;
    bool gravity_included = true;
    bool mount_auto = false; ///< the mounting is to be found from the motion
    std::optional<std::array<double, 3>> mount_rpy_deg;      ///< sensor to vehicle
    std::optional<std::array<double, 4>> mount_quat;         ///< w x y z, sensor to vehicle
    std::optional<std::array<double, 3>> acc_sensor_pos_m;   ///< behind the front axle, left, up
    std::optional<std::array<double, 3>> gnss_antenna_pos_m; ///< behind the front axle, left, up
    bool frame_stated = false;
    bool gnss_latency_stated = false;
    double gnss_latency_s = 0;
    double gnss_latency_sd_s = 0; ///< of an estimate; 0: not known
    double speed_latency_s = 0;
    std::optional<double> speed_scale;        ///< true speed = scale * logged speed
    std::map<std::string, std::string> other; ///< every key that is not one of the above
};

/// Which sensors a row of the log held.
namespace row_content {
inline constexpr std::uint8_t acc = 1;
inline constexpr std::uint8_t gyro = 2;
inline constexpr std::uint8_t speed = 4;
inline constexpr std::uint8_t fix = 8;
} // namespace row_content

/// Why a row gave nothing. The names of reasons, as users see them, come from `name_of`.
enum class RowReason : std::uint8_t {
    wrong_cell_count = 16,
    bad_number,
    out_of_range,
    no_time,
    no_sample,           ///< every cell but the time is empty
    time_not_increasing, ///< out of the order of its sensor's other samples
    unused_channel,      ///< its sensors are not needed by the method in use
    too_slow,
    short_stretch, ///< too short a part without gaps to say anything
    no_speed,      ///< vibration with no speed known at its time
    implausible,   ///< a position or speed that the neighbours contradict
    inaccurate,    ///< a position that the receiver itself gives little for
    repeated_fix,  ///< the fix before it once more, as loggers write on every fast row
    merged,        ///< added to another row's reading, as gravity is to acceleration
    trimmed,       ///< too near to where the trip began or ended to be told
    sensor_moved,  ///< the sensor hung otherwise than for most of the trip
};
const char* name_of(RowReason reason);

/// What one car recorded from start to stop, sensor by sensor.
///
/// `rows` has one entry a data row of the log, in its order: a sum of row_content flags for the
/// samples that it gave to the streams (the n-th row with a flag gave that stream's n-th sample),
/// or a RowReason (>= 16) if it gave none. So every row can be accounted for in the end.
struct TripLog {
    TripMeta meta;
    std::string sha256;   ///< of the decompressed content, 64 lower-case hex digits
    TriaxialSamples acc;  ///< specific force, m/s2, in meta.frame
    TriaxialSamples gyro; ///< rad/s, in meta.frame
    SpeedSamples speed;
    std::vector<GnssFix> fixes;
    std::vector<std::uint8_t> rows;
    std::vector<std::string> unknown_columns;
};

/// Which samples of a trip entered an estimate: one flag a sample of each stream, and for those
/// that did not, why.
struct RowAudit {
    std::vector<std::uint8_t> acc; ///< 0 = used, otherwise a RowReason
    std::vector<std::uint8_t> gyro;
    std::vector<std::uint8_t> speed;
    std::vector<std::uint8_t> fixes;
};

struct RowCount {
    std::size_t read = 0;
    std::size_t used = 0;
    std::size_t rejected = 0; ///< read = used + rejected, always
    std::map<std::string, std::size_t> reasons;
    friend bool operator==(const RowCount&, const RowCount&) = default;
};

/// A row is used if at least one of its samples was; otherwise it is rejected once, with the first
/// reason in the order acc, gyro, speed, fix.
RowCount account(const TripLog& trip, const RowAudit& use);

} // namespace macadam
