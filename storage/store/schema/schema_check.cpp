#include "storage/store/schema/schema_check.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

struct KnownTable {
    const char* name;
    const char* sql;
};

/// Legitimate additions: ANALYZE (https://sqlite.org/fileformat2.html, 2.6.3 and 2.6.5), and QGIS
/// when a project is saved into the file. They are plain tables, and we do not read the last one.
constexpr std::array known_tables{
    KnownTable{"sqlite_stat1", "CREATE TABLE sqlite_stat1(tbl,idx,stat)"},
    KnownTable{"sqlite_stat4", "CREATE TABLE sqlite_stat4(tbl,idx,neq,nlt,ndlt,sample)"},
    KnownTable{"qgis_projects",
               "CREATE TABLE qgis_projects(name TEXT PRIMARY KEY, metadata BLOB, content BLOB)"}};

bool is_known(const SchemaObject& object) {
    const auto known = std::ranges::find(known_tables, object.table, &KnownTable::name);
    if (known == known_tables.end()) {
        return false;
    }
    const bool is_table =
        object.type == "table" && object.name == object.table && object.sql == known->sql;
    const bool is_own_index = object.type == "index" && object.sql.empty() &&
                              object.name == fmt::format("sqlite_autoindex_{}_1", object.table);
    return is_table || is_own_index;
}

/// Object kind for messages; `type` may be any text.
std::string kind_of(const std::string& type) {
    if (type == "index") {
        return "an index";
    }
    const bool is_plain = type == "table" || type == "view" || type == "trigger";
    return "a " + (is_plain ? type : in_quotes(type));
}

Schema make_own_schema(PrivacyProfile privacy) {
    Database database{"an empty database", Database::Access::memory};
    make_store_tables(database, privacy);
    return read_schema(database);
}

} // namespace

Schema read_schema(Database& database) {
    auto select = database.prepare("SELECT type, name, tbl_name, sql FROM sqlite_schema");
    Schema schema;
    while (select.step()) {
        SchemaObject object{select.text(0), select.text(1), select.text(2), select.text(3)};
        auto key = std::pair{object.type, object.name};
        if (!schema.emplace(std::move(key), std::move(object)).second) {
            throw InputError{fmt::format("{}: is damaged: it contains {} {} twice",
                                         database.file().string(),
                                         in_quotes(select.text(0)),
                                         in_quotes(select.text(1)))};
        }
    }
    return schema;
}

const Schema& own_schema(PrivacyProfile privacy) {
    if (privacy == PrivacyProfile::crowd) {
        static const Schema crowd = make_own_schema(PrivacyProfile::crowd);
        return crowd;
    }
    static const Schema own = make_own_schema(PrivacyProfile::own);
    return own;
}

void expect_no_foreign_object(Database& database, const Schema& found, const Schema& expected) {
    for (const auto& [key, object] : found) {
        const auto own = expected.find(key);
        if ((own != expected.end() && own->second == object) || is_known(object)) {
            continue;
        }
        throw InputError{fmt::format(
            "{}: contains {} {} that does not belong to Macadam{}, expected a database as made "
            "by 'macadam init'; none of it was executed",
            database.file().string(),
            kind_of(object.type),
            in_quotes(object.name),
            own != expected.end() ? " (its definition differs)" : "")};
    }
}

void expect_whole_schema(Database& database, const Schema& found, const Schema& expected) {
    for (const auto& [key, object] : expected) {
        if (!found.contains(key)) {
            throw InputError{fmt::format("{}: lacks the {} '{}'; the database was modified by "
                                         "another program",
                                         database.file().string(),
                                         object.type,
                                         object.name)};
        }
    }
}

} // namespace macadam
