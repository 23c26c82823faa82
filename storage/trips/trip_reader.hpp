#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <string>

namespace macadam {

/// SHA-256 of the decompressed content of a trip, without parsing it: a quick test for known trips.
std::string content_sha256(const TripSource& source);

/// Reads a "macadam-trip 1" log, plain, .gz or .zst, as a stream: its samples, and for every data
/// row its contribution or the reason why it has none. By suffix also rawlogs
/// (storage/trips/rawlog/rawlog_reader.hpp) and GPX tracks (storage/trips/foreign/gpx_reader.hpp).
///
/// \throws InputError  "file:line: ..." if it is not such a log, lacks a required column, or does
///                     not end with "# end rows: N" and the correct N.
TripLog read_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress = {});

} // namespace macadam
