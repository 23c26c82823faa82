#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Whether a file or member is called like a GPX track: .gpx, .gpx.gz or .gpx.zst.
bool is_gpx_name(std::string_view name);

/// Where a track's bytes come from.
struct GpxSource {
    std::unique_ptr<ByteStream> bytes; ///< decompressed
    std::string name;                  ///< for messages
    std::size_t whole_bytes;           ///< on disk, for progress; 0: not known
};

/// A key of TripMeta::other: the log has no times, and how they were made up.
inline constexpr const char* times_key = "times";

/// Reads the tracks of a GPX file, 1.0 or 1.1, as one trip: every track point is a row with its
/// place, its time, and `speed` (m/s), `course` (degrees) and `accuracy` (m) where it has them, as
/// elements of its own or among its extensions. Routes and way points are not read.
///
/// Segments come in the order of their first times. Where fewer than half of the points have a time
/// later than the one before, times are made up, as if driven at 10 m/s with a minute between
/// segments, and `times_key` says so.
///
/// Entities that the file declares are refused, and names, texts and depth are bounded.
///
/// \throws InputError  "file:line: ..." if it is no GPX, is cut off, or holds no track point; or if
///                     a column is needed that a GPX file does not have.
TripLog read_gpx(GpxSource source, const TripNeeds& needs, const Progress& progress = {});

} // namespace macadam
