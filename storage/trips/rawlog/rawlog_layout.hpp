#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

// How objects lie in a rawlog. MRPT's own reader believes every count and length that it finds, so
// nothing is handed to it before its extent was walked here: no byte of a broken file can make it
// ask for more than the file holds.

enum class RawlogClass : std::uint8_t {
    imu,      ///< CObservationIMU
    gps,      ///< CObservationGPS
    odometry, ///< CObservationOdometry
    comment,  ///< CObservationComment
    frame,    ///< CSensoryFrame, which holds observations
    other,
};

/// What an object begins with: the length of its class name with the highest bit set, the name, and
/// a version.
struct RawlogHead {
    RawlogClass kind;
    std::string name; ///< "CObservationIMU", without its namespace
    int version;
    std::size_t size; ///< in bytes
};

inline constexpr char rawlog_end_flag = '\x88'; // behind every object

/// The head at the front of `bytes`; nothing: more bytes are needed to say.
/// \throws InputError  if no object begins so; without a place.
std::optional<RawlogHead> rawlog_head(std::string_view bytes);

/// How long an object of a known class is, its head and end flag included; nothing: more bytes are
/// needed. 0: it holds messages of receivers that are not looked at, and its end is not to be told
/// from within.
/// \throws InputError  if it is not laid out as its class and version want; without a place.
std::optional<std::size_t> rawlog_size(const RawlogHead& head, std::string_view bytes);

/// A whole object of a GPS as MRPT wrote it before 1.4, but for what receivers of Topcon said,
/// which nobody looks at: MRPT 2.5 reads that into memory which it has already freed. Nothing: MRPT
/// may have the object as it is.
std::optional<std::string> without_topcon(std::string_view object);

/// How many observations a frame holds, which begin `size` bytes after its own begin.
struct RawlogFrame {
    std::size_t count;
    std::size_t size;
};
std::optional<RawlogFrame> rawlog_frame(const RawlogHead& head, std::string_view bytes);

/// Whether `bytes` begin like an object that can stand by itself in a rawlog; nothing: more bytes
/// are needed to say.
std::optional<bool> begins_observation(std::string_view bytes);

} // namespace macadam
