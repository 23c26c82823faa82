#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <string>

namespace macadam {

/// SHA-256 of the decompressed content of a trip, without reading it as one: to know quickly
/// whether it is known.
std::string content_sha256(const TripSource& source);

/// Reads a "macadam-trip 1" log, plain, .gz or .zst, as a stream: its samples, and for every data
/// row what it gave or why it gave nothing. By their names also rawlogs
/// (storage/trips/rawlog/rawlog_reader.hpp) and GPX tracks (storage/trips/foreign/gpx_reader.hpp).
///
/// \throws InputError  "file:line: ..." if it is not such a log, lacks a needed column, or does
///                     not end with "# end rows: N" and the right N.
TripLog read_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress = {});

} // namespace macadam
