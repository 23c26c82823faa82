#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

enum class RawlogClass : std::uint8_t {
    imu,      ///< CObservationIMU
    gps,      ///< CObservationGPS
    odometry, ///< CObservationOdometry
    comment,  ///< CObservationComment
    frame,    ///< CSensoryFrame, a container of observations
    other,
};

/// Header of an object: the length of its class name with the highest bit set, the name, and a
/// version.
struct RawlogHead {
    RawlogClass kind;
    std::string name; ///< "CObservationIMU", without its namespace
    int version;
    std::size_t size; ///< in bytes
};

inline constexpr char rawlog_end_flag = '\x88'; // after every object

/// Parses the header at the start of `bytes`; `std::nullopt`: more bytes are needed.
///
/// \throws InputError  if this is not the header of an object; the message has no position.
std::optional<RawlogHead> rawlog_head(std::string_view bytes);

/// Tests whether `bytes` begin like an object that may stand alone in a rawlog; `std::nullopt`:
/// more bytes are needed.
std::optional<bool> begins_observation(std::string_view bytes);

} // namespace macadam
