#pragma once

struct sqlite3;

namespace macadam {

/// Defends against a database that others made: it may hold triggers, views and rows made to harm.
///
/// The schema check (storage/store/schema/schema_check.hpp) finds views and triggers that are not
/// ours, but they cannot run even before it: all of the file are off (those in temp, which are
/// ours, are not), no function runs from the schema that is not declared harmless, no extension is
/// loaded, and no SQL writes what only SQLite writes.
void guard_from_others(sqlite3* database);

} // namespace macadam
