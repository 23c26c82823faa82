#pragma once

#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Column of a table on a server.
struct ServerColumn {
    const char* name;
    const char* type; ///< of PostgreSQL, with NOT NULL
    const char* meaning;
};

/// Right that a role has on a table.
enum class ServerUse {
    road,  ///< readers see it: roads and fused values
    trips, ///< personal data or bookkeeping: importers and operators only
};

/// Table on a server. Copied tables have the same rows in a GeoPackage, of which columns are named
/// alike unless `file_columns` says otherwise.
struct ServerTable {
    const char* name;
    const char* meaning;
    ServerUse use;
    std::span<const ServerColumn> columns;
    const char* constraints;            ///< "PRIMARY KEY (id)", ...
    const char* partition_by = nullptr; ///< column whose values each have a partition
    const char* file_table = nullptr;   ///< null: not copied row by row
    const char* file_columns = nullptr; ///< null: as on the server
    int migration = 1;                  ///< that creates it
};

/// All tables of roads, trips and values, in an order in which references are to earlier ones.
std::span<const ServerTable> server_tables();

/// Names of all columns, separated by commas.
std::string column_list(const ServerTable& table);

/// The same with the name of the table, "NAME.COLUMN".
std::string qualified_column_list(const ServerTable& table);

/// The same as column_list() in double quotes, as SQLite needs them for names that are words of
/// SQL.
std::string quoted_column_list(const ServerTable& table);

/// "macadam.NAME (COLUMN, ...)", as COPY takes it.
std::string copy_target(const ServerTable& table);

const ServerTable& server_table(std::string_view name);

} // namespace macadam
