#pragma once

#include "estimator/common/trip.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Tests for the name of a GPX track: .gpx, .gpx.gz or .gpx.zst.
bool is_gpx_name(std::string_view name);

/// Key of TripMeta::other for a log without times; its value states how times were made up.
inline constexpr const char* times_key = "times";

/// Reads the tracks of a GPX file, 1.0 or 1.1, as one trip: every track point is a row with its
/// position, time, and `speed` (m/s), `course` or `bearing` (degrees) and `accuracy` (m) or else
/// `hdop` if present, as own elements or extensions of any namespace. Routes and way points are
/// ignored.
///
/// Track segments are sorted by their first times. If fewer than half of the points have a time
/// later than that of the previous point, times are made up, as if driven at 10 m/s with a minute
/// between track segments, and `times_key` says so.
///
/// Entities that the file declares are refused, and lengths of names and texts and the depth are
/// bounded.
///
/// \param bytes  decompressed
/// \param name  for messages
///
/// \throws InputError  "file:line: ..." if it is not GPX, is truncated, or holds no track point; or
///                     if a column is required that a GPX file does not have.
TripLog
read_gpx(std::unique_ptr<ByteStream> bytes, const std::string& name, const TripNeeds& needs);

} // namespace macadam
