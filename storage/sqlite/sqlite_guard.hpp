#pragma once

struct sqlite3;

namespace macadam {

/// Defends against a database from an untrusted source, which may hold malicious triggers, views
/// and rows.
///
/// The schema check (storage/store/schema/schema_check.hpp) finds foreign views and triggers, but
/// they cannot run even before it: all views and triggers of the file are disabled (those in temp,
/// which are ours, are not), the schema can only call functions that are declared innocuous,
/// extensions are not loaded, and SQL cannot write SQLite's internal tables.
void guard_from_others(sqlite3* database);

} // namespace macadam
