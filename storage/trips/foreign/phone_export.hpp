#pragma once

#include "storage/trips/foreign/column_mapping.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <string>
#include <vector>

namespace macadam {

/// \throws InputError  naming the file that an export lacks for what is needed of it.
void expect_files_of_export(const TripSource& source, const TripNeeds& needs);

/// Those of an export's files that make its trip.
std::vector<std::string> used_files(const TripSource& source);

/// How a phone's export becomes a trip. Phones lie as they like: the mounting is to be found from
/// the motion.
///
/// phyphox: tables by sensor with a common clock; meta/time.csv, if there, tells the date and the
/// pauses in which the clock stood. Sensor Logger: nanoseconds since 1970; acceleration with
/// gravity where there is such a file, else gravity is added from its own; on iOS all axes point
/// the other way unless the export says that it is standardised.
///
/// \throws InputError  if the files are of neither.
TripMapping mapping_of_export(const TripSource& source);

} // namespace macadam
