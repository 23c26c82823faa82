#pragma once

#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Checks that an export has the required files.
///
/// \throws InputError  naming the missing file.
void expect_files_of_export(const TripSource& source, const TripNeeds& needs);

/// Files of an export that its trip consists of.
std::vector<std::string> used_files(const TripSource& source);

/// Mapping of a phone export. The orientation of the phone is unknown and must be estimated from
/// the motion.
///
/// phyphox: tables by sensor with a common clock; meta/time.csv, if present, holds the date and the
/// pauses of the clock. Sensor Logger: nanoseconds since 1970; acceleration with gravity if there
/// is such a file, otherwise gravity is added from its own file; on iOS all axes are reversed
/// unless the export states that it is standardised.
///
/// \throws InputError  if the files are of neither app.
TripMapping mapping_of_export(const TripSource& source);

} // namespace macadam
