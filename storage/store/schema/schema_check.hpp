#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/records/privacy_profile.hpp"

#include <map>
#include <string>
#include <utility>

namespace macadam {

/// Table, index, view or trigger of a database, as in table sqlite_schema.
struct SchemaObject {
    std::string type;
    std::string name;
    std::string table; ///< table to which it belongs
    std::string sql;   ///< statement that created it; "" = created by SQLite itself
    friend bool operator==(const SchemaObject&, const SchemaObject&) = default;
};

/// Objects by type and name, because a trigger may have the name of a table.
using Schema = std::map<std::pair<std::string, std::string>, SchemaObject>;

/// Reads sqlite_schema without running any code of the database.
/// \throws InputError  if an object occurs twice.
Schema read_schema(Database& database);

/// All objects of a database that 'macadam init' creates.
const Schema& own_schema(PrivacyProfile privacy = PrivacyProfile::own);

/// Checks for foreign objects. Views and triggers of an untrusted database would run inside our own
/// statements, so each object must equal one of `expected`, or be one of the few tables that SQLite
/// and QGIS add.
///
/// \throws InputError  naming the foreign object.
void expect_no_foreign_object(Database& database, const Schema& found, const Schema& expected);

/// Checks for missing objects.
///
/// \throws InputError  naming the first of `expected` that is missing.
void expect_whole_schema(Database& database, const Schema& found, const Schema& expected);

} // namespace macadam
