#pragma once

#include "estimator/common/trip.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace macadam {

inline constexpr std::string_view rawlog_suffix = ".rawlog";

/// First line of the comment that holds the header of a trip.
inline constexpr std::string_view rawlog_head_mark = "# macadam-trip 1";

/// Key in that header: metres of horizontal accuracy per unit of HDOP, because GGA cannot state the
/// accuracy itself. Rawlogs from other programs have neither the key nor an accuracy.
inline constexpr const char* rawlog_accuracy_key = "hacc_per_hdop_m";

/// Reads a rawlog of MRPT: CObservationIMU, CObservationGPS (NMEA GGA and RMC) and
/// CObservationOdometry become samples, a CObservationComment that begins with "# macadam-trip 1"
/// is the header of the trip. Every object is a row; objects of other classes, and of all but the
/// most frequent sensor of a kind, count as `unused_channel`. docs/reference/other-loggers.md
/// describes the conversion of each field.
///
/// \param bytes  decompressed
/// \param name  for messages
///
/// \throws InputError  "file: object N at byte B: ..." if it is not a rawlog, is truncated or
///                     damaged, or lacks the sensors of a required column.
TripLog
read_rawlog(std::unique_ptr<ByteStream> bytes, const std::string& name, const TripNeeds& needs);

} // namespace macadam
