#pragma once

#include "estimator/common/trip.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <stop_token>
#include <string>

namespace macadam {

/// Tests whether a trip is a phone export or a file with a mapping, not a log of our own.
bool is_foreign(const TripSource& source);

/// SHA-256 over the decompressed content of the trip's files, in byte order of their names: equal
/// for a folder and its archive. The source has its contents (trip_files.hpp).
std::string foreign_sha256(const TripSource& source);

/// Reads a foreign trip from its contents: each data row of each of its files is a row of the log,
/// file by file.
///
/// \throws InputError  "file:line: ..." if a file does not match its mapping, or a required channel
///                     is missing.
TripLog read_foreign_trip(const TripSource& source,
                          const TripNeeds& needs,
                          const std::stop_token& stop = {});

} // namespace macadam
