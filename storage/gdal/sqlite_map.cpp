#include "storage/gdal/sqlite_map.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <sqlite3.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <set>
#include <string>
#include <string_view>

namespace macadam {
namespace {

namespace fs = std::filesystem;

struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Query = std::unique_ptr<sqlite3_stmt, Finalize>;

std::string text_in(sqlite3_stmt* row, int column) {
    const auto* const text = sqlite3_column_text(row, column);
    return text == nullptr ? std::string{} : reinterpret_cast<const char*>(text);
}

/// Builds the URI of a file (https://sqlite.org/uri.html, 3).
std::string uri_of(const fs::path& file, const char* options) {
    std::string uri = "file:";
    for (const char c : fs::absolute(file).string()) {
        uri += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02x}", c) : std::string{c};
    }
    return uri + options;
}

/// Untrusted database, read with only SQLite's own modules and functions.
class ForeignDatabase {
public:
    ForeignDatabase(const fs::path& file, const char* options) : name_{file.string()} {
        sqlite3* database = nullptr;
        const int code =
            sqlite3_open_v2(uri_of(file, options).c_str(),
                            &database,
                            SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX,
                            nullptr);
        database_.reset(database);
        if (code != SQLITE_OK) {
            fail();
        }
        sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
        sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
        sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    }

    [[noreturn]] void fail() const {
        throw InputError{fmt::format(
            "{}: cannot be read as a database: {}", name_, sqlite3_errmsg(database_.get()))};
    }

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError{fmt::format("{}: {}", name_, what)};
    }

    /// Prepares a query; empty on failure.
    Query prepared(const char* sql) const {
        sqlite3_stmt* statement = nullptr;
        sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr);
        return Query{statement};
    }

    template <typename Take>
    void each_row(const char* sql, const Take& take) const {
        const auto query = prepared(sql);
        int code = query ? sqlite3_step(query.get()) : SQLITE_ERROR;
        for (; code == SQLITE_ROW; code = sqlite3_step(query.get())) {
            take(query.get());
        }
        if (code != SQLITE_DONE) {
            fail();
        }
    }

    std::string first_text(const char* sql) const {
        const auto query = prepared(sql);
        return query && sqlite3_step(query.get()) == SQLITE_ROW ? text_in(query.get(), 0)
                                                                : std::string{};
    }

    sqlite3* handle() const { return database_.get(); }

private:
    std::string name_;
    std::unique_ptr<sqlite3, Close> database_;
};

/// Recognises an R-tree by its definition: SQLite's words before the name of a virtual table, the
/// name, and " USING rtree(" with column names. Any other spelling, for example with comments, is
/// rejected.
bool is_rtree(const std::string& sql) {
    auto text = std::string_view{sql};
    constexpr std::string_view start = "create virtual table ";
    if (in_lower_case(sql.substr(0, start.size())) != start) {
        return false;
    }
    text.remove_prefix(start.size());
    const auto quote = std::string_view{"\"'`["}.find(text.empty() ? ' ' : text[0]);
    const auto end = quote != text.npos ? text.find("\"'`]"[quote], 1) : text.find(' ') - 1;
    if (end >= text.size()) {
        return false;
    }
    if (quote == text.npos && !std::ranges::all_of(text.substr(0, end + 1), [](unsigned char c) {
            return std::isalnum(c) != 0 || c == '_' || c >= 0x80;
        })) {
        return false;
    }
    const auto rest = in_lower_case(std::string{text.substr(end + 1)});
    const auto bracket = rest.find('(');
    auto words = rest.substr(0, bracket);
    words.erase(words.find_last_not_of(" \t\r\n") + 1);
    const bool says_rtree =
        words == " using rtree" || words == " using rtree_i32" || words == " using \"rtree\"";
    return says_rtree && bracket != std::string::npos &&
           rest.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_ ,\"'`\t\r\n",
                                  bracket + 1) == rest.find(')', bracket) &&
           rest.find_first_not_of(" ;\t\r\n", rest.find(')', bracket) + 1) == std::string::npos;
}

int allow_looking_up(void* /*data*/,
                     int action,
                     const char* /*first*/,
                     const char* /*second*/,
                     const char* /*database*/,
                     const char* /*view*/) {
    return action == SQLITE_SELECT || action == SQLITE_READ || action == SQLITE_FUNCTION
               ? SQLITE_OK
               : SQLITE_DENY; // recursion, above all
}

/// Tests whether a view is a plain look-up, which scans at most one table per tile.
bool is_lookup(const ForeignDatabase& database, const std::string& view) {
    sqlite3_set_authorizer(database.handle(), allow_looking_up, nullptr);
    std::string quoted;
    for (const char c : view) {
        quoted += c == '"' ? "\"\"" : std::string{c};
    }
    const bool may_run = database.prepared(("SELECT * FROM \"" + quoted + "\"").c_str()) != nullptr;
    sqlite3_set_authorizer(database.handle(), nullptr, nullptr);
    if (!may_run) {
        return false;
    }
    int scans = 0;
    const auto where = view == "tiles" ? std::string{" WHERE zoom_level = 1 AND tile_column = 1 "
                                                     "AND tile_row = 1"}
                                       : std::string{};
    database.each_row(
        ("EXPLAIN QUERY PLAN SELECT * FROM \"" + quoted + "\"" + where).c_str(),
        [&](sqlite3_stmt* row) { scans += text_in(row, 3).starts_with("SCAN") ? 1 : 0; });
    return scans <= 1;
}

struct Tables {
    std::set<std::string> names, views;
};

Tables tables_of(const ForeignDatabase& database) {
    Tables tables;
    std::set<std::string> virtual_tables;
    database.each_row("SELECT name, type FROM pragma_table_list WHERE schema = 'main'",
                      [&](sqlite3_stmt* row) {
                          const auto name = text_in(row, 0);
                          tables.names.insert(in_lower_case(name));
                          const auto type = text_in(row, 1);
                          if (type == "view") {
                              tables.views.insert(name);
                          } else if (type == "virtual") {
                              virtual_tables.insert(name);
                          }
                      });
    database.each_row("SELECT name, sql FROM sqlite_schema WHERE type = 'table'",
                      [&](sqlite3_stmt* row) {
                          const auto name = text_in(row, 0);
                          if (virtual_tables.erase(name) > 0 && !is_rtree(text_in(row, 1))) {
                              virtual_tables.insert(name);
                          }
                      });
    if (!virtual_tables.empty()) {
        database.refuse(fmt::format(
            "its table '{}' is virtual, which can run code and open other files, expected "
            "ordinary tables; ogr2ogr copies a layer into a GeoPackage",
            *virtual_tables.begin()));
    }
    return tables;
}

MapKind kind_of(const ForeignDatabase& database) {
    const auto tables = tables_of(database);
    const auto has = [&](const char* name) { return tables.names.contains(name); };
    const auto kind = has("gpkg_contents")              ? MapKind::geopackage
                      : has("tiles") && has("metadata") ? MapKind::mbtiles
                                                        : MapKind::sqlite;
    for (const auto& view : tables.views) {
        if (kind != MapKind::mbtiles || !is_lookup(database, view)) {
            database.refuse(fmt::format(
                "its table '{}' is a view, which runs code when it is read, expected ordinary "
                "tables; ogr2ogr copies a layer into a GeoPackage",
                view));
        }
    }
    return kind;
}

constexpr const char* as_it_stands = "?mode=ro";

/// Called by SQLite for each database that is opened, including by GDAL.
int distrust(sqlite3* database, char** /*error*/, const sqlite3_api_routines* /*unused*/) {
    return sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

} // namespace

MapKind kind_of_sqlite_map(const fs::path& file) {
    auto log = file;
    log += "-wal";
    std::error_code none;
    if (fs::exists(log, none)) {
        kind_of({file, "?mode=ro&immutable=1"}); // thus readable where the WAL is not
    }
    return kind_of({file, as_it_stands});
}

bool holds_vector_tiles(const fs::path& mbtiles) {
    return ForeignDatabase{mbtiles, as_it_stands}.first_text(
               "SELECT value FROM metadata WHERE name = 'format'") == "pbf";
}

bool holds_pictures(const fs::path& geopackage) {
    return !ForeignDatabase{geopackage, as_it_stands}
                .first_text("SELECT 1 FROM gpkg_contents WHERE data_type IN ('tiles', "
                            "'2d-gridded-coverage')")
                .empty();
}

void distrust_schemas() {
    sqlite3_auto_extension(reinterpret_cast<void (*)()>(distrust)); // NOLINT(*-reinterpret-cast)
}

} // namespace macadam
