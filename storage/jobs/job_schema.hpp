#pragma once

namespace macadam {

/// Statements of migration 2: tables of trips that wait for workers, and of the workers.
extern const char* const job_schema;

} // namespace macadam
