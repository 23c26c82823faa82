#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <string>

namespace macadam {

/// Whether a trip is not one log of ours but an export of a phone or a file with a mapping.
bool is_foreign(const TripSource& source);

/// SHA-256 over the decompressed content of the trip's files, in byte order of their names: a
/// folder and its archive have the same.
std::string foreign_sha256(const TripSource& source);

/// Reads a foreign trip: each data row of each of its files is a row of the log, file by file.
///
/// \throws InputError  "file:line: ..." if a file is not what its mapping says, or nothing gives a
///                     channel that is needed.
TripLog
read_foreign_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress);

} // namespace macadam
