#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Statements of migration 2: tables of trips that wait for workers, and of the workers.
std::string job_schema();

/// Statements of migration 5: which trips a log held, so that it is forgotten with them.
std::string job_trip_schema();

/// Statements of migration 10: counts of logs without reading all that were ever submitted.
std::string job_count_schema();

/// Statements of migration 13: logs that are stored, and not yet submitted.
std::string announced_log_schema();

/// Further statements of migration 13: indexes by which logs of forgotten trips are found.
std::string forgotten_log_schema();

/// Expression for the mark of a forgotten trip, that of forgotten_mark()
/// (storage/store/rows/known_trips.hpp), as it is indexed.
/// \param hash  column with the SHA-256 of a trip, in hex digits
std::string mark_expression(std::string_view hash);

} // namespace macadam
