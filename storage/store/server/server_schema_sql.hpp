#pragma once

#include <string>

namespace macadam {

// Statements that make the schema of a database on a server; its tables are made from
// server_tables().

extern const char* const schema_begin_sql; ///< schema, and the table of migrations
extern const char* const schema_indexes_sql;
extern const char* const schema_unpacking_sql; ///< function and view that unpack passes
extern const char* const schema_roughness_sql; ///< the view for QGIS
extern const char* const schema_cells_sql;     ///< function that creates partitions
/// Rights: {0} stands for what all read, {1} for what importers write.
extern const char* const schema_roles_sql;

/// Migration 4: what changed, for copies that are kept.
std::string changes_migration_sql();

/// Migration 6: a mark for each trip over a chunk, which nobody waits for.
extern const char* const marks_migration_sql;

/// Migration 7, once its tables are there.
std::string publications_migration_sql();

/// Migration 8: old changes of values are removed.
extern const char* const old_changes_migration_sql;

/// Migration 9: times of the first and last pass are found by indexes.
extern const char* const seen_migration_sql;

/// Migration 11: readers see no marks of single trips, importers change and remove none, and views
/// explain their columns.
extern const char* const narrow_rights_migration_sql;

} // namespace macadam
