#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <map>
#include <string>
#include <utility>

namespace macadam {

/// A table, index, view or trigger of a database, as table sqlite_schema has it.
struct SchemaObject {
    std::string type;
    std::string name;
    std::string table; ///< that it is of
    std::string sql;   ///< by which it was made; "" = made by SQLite itself
    friend bool operator==(const SchemaObject&, const SchemaObject&) = default;
};

/// By type and name: a trigger may be called as a table is.
using Schema = std::map<std::pair<std::string, std::string>, SchemaObject>;

/// Reads only what stands in sqlite_schema: nothing of the database is run.
/// \throws InputError  if an object stands there twice.
Schema read_schema(Database& database);

/// All objects of a database that 'macadam init' makes.
const Schema& own_schema();

/// Views and triggers of a database from others run inside of our own statements, so there must be
/// none but ours: each object is one of `expected` to the letter, or one of the few tables that
/// SQLite and QGIS add.
///
/// \throws InputError  names the object that is not.
void expect_no_foreign_object(Database& database, const Schema& found, const Schema& expected);

/// \throws InputError  names the first of `expected` that is not there.
void expect_whole_schema(Database& database, const Schema& found, const Schema& expected);

} // namespace macadam
