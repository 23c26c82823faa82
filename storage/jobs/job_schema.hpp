#pragma once

#include <string>

namespace macadam {

/// Statements of migration 2: tables of trips that wait for workers, and of the workers.
std::string job_schema();

/// Statements of migration 5: which trips a log held, so that it is forgotten with them.
std::string job_trip_schema();

/// Statements of migration 10: counts of logs without reading all that were ever submitted.
std::string job_count_schema();

/// Statements of migration 13: logs that are stored, and not yet submitted.
std::string announced_log_schema();

} // namespace macadam
