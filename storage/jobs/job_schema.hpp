#pragma once

namespace macadam {

/// Statements of migration 2: tables of trips that wait for workers, and of the workers.
extern const char* const job_schema;

/// Statements of migration 5: which trips a log held, so that it is forgotten with them.
extern const char* const job_trip_schema;

} // namespace macadam
