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

inline constexpr std::string_view rawlog_suffix = ".rawlog";

/// What the comment begins with that is the head of a trip.
inline constexpr std::string_view rawlog_head_mark = "# macadam-trip 1";

/// A key of that head: metres of horizontal accuracy for each unit of HDOP. GGA has no place for
/// the accuracy itself; rawlogs that were not written here do not have the key, and no accuracy.
inline constexpr const char* rawlog_accuracy_key = "hacc_per_hdop_m";

/// Where a rawlog's bytes come from.
struct RawlogSource {
    std::unique_ptr<ByteStream> bytes; ///< decompressed
    std::string name;                  ///< for messages
    std::size_t whole_bytes;           ///< on disk, for progress; 0: not known
};

/// Reads a rawlog of MRPT: CObservationIMU, CObservationGPS (NMEA GGA and RMC) and
/// CObservationOdometry become samples, a CObservationComment that begins with "# macadam-trip 1"
/// is the head of the trip. Every object is a row; those of other classes, and of all but the most
/// frequent sensor of a kind, give `unused_channel`. docs/reference/other-loggers.md says what
/// becomes of each field.
///
/// \throws InputError  "file: object N at byte B: ..." if it is no rawlog, is cut off or damaged,
///                     or lacks the sensors of a needed column.
TripLog read_rawlog(RawlogSource source, const TripNeeds& needs, const Progress& progress = {});

} // namespace macadam
