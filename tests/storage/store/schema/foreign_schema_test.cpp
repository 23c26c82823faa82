// Databases that others made: what stands in them besides our own tables is refused, never run.

#include "storage/store/road_store.hpp"
#include "storage/store/schema/schema_check.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <ctime>
#include <memory>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

using ::testing::AnyOf;
using ::testing::HasSubstr;

struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};

/// Changes the file as its owner may, who knows no defence. \returns false if SQLite refuses.
bool change(const fs::path& file, const std::string& sql) {
    sqlite3* handle = nullptr;
    sqlite3_open(file.c_str(), &handle);
    const std::unique_ptr<sqlite3, Close> database{handle};
    sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 0, nullptr);
    sqlite3_exec(handle, "PRAGMA synchronous = OFF", nullptr, nullptr, nullptr);
    return sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
}

/// Never ends.
constexpr const char* endless = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c)";

/// Writes another text into sqlite_schema, which SQLite only parses.
std::string rewritten(const SchemaObject& object, const std::string& sql) {
    return fmt::format("PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = '{}' WHERE"
                       " type = '{}' AND name = '{}'",
                       sql,
                       object.type,
                       object.name);
}

std::string quoted(std::string text) {
    for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 2) {
        text.insert(at, 1, '\'');
    }
    return text;
}

/// Of a table: columns, constraints and whatever else can be said of it, said otherwise.
std::vector<std::string> changes_of_table(const SchemaObject& table) {
    const auto& name = table.name;
    const auto other = quoted(table.sql);
    const auto replaced = [&](const std::string& from, const std::string& to) {
        auto sql = other;
        const auto at = sql.rfind(from);
        return rewritten(table,
                         at == std::string::npos ? sql + " " : sql.replace(at, from.size(), to));
    };
    return {
        fmt::format(
            "ALTER TABLE {0} RENAME TO x; CREATE VIEW {0} AS {1} SELECT * FROM c", name, endless),
        fmt::format("ALTER TABLE {0} RENAME TO x; CREATE VIEW {0} AS SELECT * FROM x", name),
        fmt::format("ALTER TABLE {0} RENAME TO x; CREATE TABLE {0} AS SELECT * FROM x", name),
        fmt::format("ALTER TABLE {0} RENAME TO x; CREATE VIRTUAL TABLE {0} USING rtree(a, b, c)",
                    name),
        fmt::format("ALTER TABLE {0} RENAME TO x; CREATE VIRTUAL TABLE {0} USING fts5(a)", name),
        fmt::format("ALTER TABLE {0} ADD COLUMN extra TEXT", name),
        fmt::format("ALTER TABLE {0} ADD COLUMN extra AS (randomblob(100000000)) VIRTUAL", name),
        fmt::format("ALTER TABLE {0} ADD COLUMN extra TEXT CHECK (extra IN ({1} SELECT x FROM c))",
                    name,
                    endless),
        fmt::format("CREATE TRIGGER x AFTER INSERT ON {0} BEGIN DELETE FROM pass; END", name),
        fmt::format("CREATE TRIGGER x BEFORE UPDATE ON {0} BEGIN {1} SELECT count(*) FROM c; END",
                    name,
                    endless),
        fmt::format("CREATE TRIGGER {0} AFTER DELETE ON {0} BEGIN SELECT RAISE(IGNORE); END", name),
        fmt::format("CREATE INDEX x ON {0}(abs(rowid))", name),
        fmt::format("CREATE UNIQUE INDEX x ON {0}(1) WHERE length(randomblob(9)) > 3", name),
        fmt::format(
            "CREATE VIEW x AS {1} SELECT x, (SELECT count(*) FROM {0}) FROM c", name, endless),
        fmt::format("CREATE TABLE x AS SELECT * FROM {0}", name),
        fmt::format("DROP TABLE {0}", name),
        replaced(")", ", CHECK (length(randomblob(1000000000)) > 0))"),
        replaced("INTEGER", "INTEGER DEFAULT (abs(-1))"),
        replaced("TEXT", "TEXT COLLATE nocase"),
        replaced("CREATE TABLE", "CREATE  TABLE"),
        rewritten(table, other + "-- "),
        rewritten(table, other + " STRICT"),
        rewritten(table, other + " WITHOUT ROWID, STRICT"),
        rewritten(table, "create table " + name + "(a)"),
        rewritten(table, "CREATE TABLE " + name + " AS SELECT randomblob(1000000000)"),
        rewritten(table, "CREATE TRIGGER " + name + " AFTER INSERT ON pass BEGIN SELECT 1; END"),
        fmt::format("CREATE TRIGGER x AFTER UPDATE ON {0} WHEN length(randomblob(1000000000)) > 0"
                    " BEGIN SELECT 1; END",
                    name),
        fmt::format("CREATE VIEW \"{0} \" AS SELECT * FROM {0}", name),
        fmt::format("CREATE TABLE \"x{0}\"(a REFERENCES {0} ON DELETE CASCADE)", name),
        rewritten(table, ""),
        rewritten(table, "CREATE VIEW " + name + " AS SELECT 1"),
    };
}

std::vector<std::string> changes_of(const SchemaObject& object) {
    if (object.type == "table" && !object.name.starts_with("sqlite_") &&
        !object.sql.starts_with("CREATE VIRTUAL")) {
        return changes_of_table(object);
    }
    std::vector<std::string> changes{
        rewritten(object, quoted(object.sql) + " "),
        fmt::format("PRAGMA writable_schema = ON; UPDATE sqlite_schema SET tbl_name = 'pass' WHERE"
                    " type = '{0}' AND name = '{1}' AND tbl_name <> 'pass';"
                    "UPDATE sqlite_schema SET name = name || '2' WHERE type = '{0}' AND"
                    " name = '{1}'",
                    object.type,
                    object.name),
        fmt::format("PRAGMA writable_schema = ON; UPDATE sqlite_schema SET type = 'thing' WHERE"
                    " type = '{}' AND name = '{}'",
                    object.type,
                    object.name),
        fmt::format("PRAGMA writable_schema = ON; DELETE FROM sqlite_schema WHERE type = '{}' AND"
                    " name = '{}'",
                    object.type,
                    object.name)};
    if (object.type == "view") {
        changes.push_back(fmt::format(
            "DROP VIEW {0}; CREATE VIEW {0} AS {1} SELECT * FROM c", object.name, endless));
        changes.push_back(fmt::format("DROP VIEW {0}; CREATE TABLE {0}(a)", object.name));
        changes.push_back(fmt::format("CREATE TRIGGER x INSTEAD OF INSERT ON {} BEGIN"
                                      " DELETE FROM pass; END",
                                      object.name));
    }
    if (object.type == "trigger") {
        changes.push_back(fmt::format("DROP TRIGGER {0}; CREATE TRIGGER {0} AFTER INSERT ON"
                                      " segment BEGIN DELETE FROM pass; END",
                                      object.name));
    }
    return changes;
}

class ForeignSchema : public ::testing::Test {
protected:
    static fs::path plain_store(const fs::path& folder) {
        const auto file = folder / "plain.gpkg";
        auto store = new_store(file);
        import_trips(store, 2);
        return file;
    }
};

TEST_F(ForeignSchema, OfHundredsOfKindsIsRefusedBeforeAnythingOfItRuns) {
    const auto folder = test_folder();
    const auto plain = plain_store(folder);
    const auto file = folder / "roads.gpkg";
    int tried = 0;
    for (const auto& [key, object] : own_schema()) {
        for (const auto& sql : changes_of(object)) {
            fs::copy_file(plain, file, fs::copy_options::overwrite_existing);
            if (!change(file, sql)) {
                continue;
            }
            ++tried;
            EXPECT_THAT(refusal_of([&] {
                            tried % 2 == 0 ? StoreReader::open(file) : RoadStore::open(file);
                        }),
                        AnyOf(HasSubstr(" that does not belong to Macadam"),
                              HasSubstr(": lacks the "),
                              HasSubstr(": is damaged: "),
                              HasSubstr("not a Macadam database")))
                << sql;
        }
    }
    EXPECT_GE(tried, 600);
}

TEST_F(ForeignSchema, IsNamedInTheRefusal) {
    const auto folder = test_folder();
    const auto plain = plain_store(folder);
    ASSERT_TRUE(change(plain, "CREATE VIEW \"x\x1b[2J\" AS SELECT 1"));
    EXPECT_EQ(refusal_of([&] { StoreReader::open(plain); }),
              plain.string() + ": contains a view 'x\\x1b[2J' that does not belong to Macadam, "
                               "expected a database as made by 'macadam init'; none of it was "
                               "executed");
}

TEST_F(ForeignSchema, OfAViewWithoutEndIsRefusedAtOnce) {
    const auto folder = test_folder();
    const auto plain = plain_store(folder);
    for (const auto* const table : {"segment_state", "meta", "way"}) {
        const auto file = folder / "roads.gpkg";
        fs::copy_file(plain, file, fs::copy_options::overwrite_existing);
        ASSERT_TRUE(change(file,
                           fmt::format("ALTER TABLE {0} RENAME TO s0;"
                                       "CREATE VIEW {0} AS {1} SELECT x AS key, 1 AS value FROM c",
                                       table,
                                       endless)));
        const auto begin = std::clock();
        EXPECT_THAT(refusal_of([&] { StoreReader::open(file); }),
                    AnyOf(HasSubstr(" that does not belong to Macadam"),
                          HasSubstr("not a Macadam "
                                    "database")));
        EXPECT_LT(std::clock() - begin, 5 * CLOCKS_PER_SEC); // of work, whoever works beside it
    }
}

TEST_F(ForeignSchema, OfSqliteItselfAndOfQgisIsLetIn) {
    const auto folder = test_folder();
    const auto plain = plain_store(folder);
    ASSERT_TRUE(change(plain,
                       "ANALYZE; CREATE TABLE qgis_projects(name TEXT PRIMARY KEY, metadata BLOB, "
                       "content BLOB); INSERT INTO qgis_projects VALUES ('mine', '', '');"
                       "INSERT INTO layer_styles (styleName) VALUES ('mine')"));
    EXPECT_EQ(RoadStore::open(plain).info().trips, 2U);
    ASSERT_TRUE(change(plain, "ALTER TABLE qgis_projects ADD COLUMN other AS (1)"));
    EXPECT_THAT(refusal_of([&] { StoreReader::open(plain); }),
                HasSubstr("a table 'qgis_projects' that does not belong to Macadam"));
}

TEST(GuardedDatabase, RunsNoViewOrTriggerOfTheFileButItsOwnInTemp) {
    const auto file = test_folder() / "a.db";
    ASSERT_TRUE(change(file,
                       "CREATE TABLE a(b); CREATE VIEW v AS SELECT 1;"
                       "CREATE TRIGGER t AFTER INSERT ON a BEGIN INSERT INTO a VALUES (7); END"));
    Database database{file, Database::Access::write};
    EXPECT_THAT(refusal_of([&] { database.run("SELECT * FROM v"); }), HasSubstr("prohibited"));
    database.run("INSERT INTO a VALUES (1)");
    EXPECT_EQ(database.number("SELECT count(*) FROM a"), 1);
    database.run("CREATE TEMP VIEW w AS SELECT 5 AS five");
    EXPECT_EQ(database.number("SELECT five FROM w"), 5);
    EXPECT_THAT(refusal_of([&] { database.run("ATTACH ':memory:' AS other"); }),
                HasSubstr("too many attached databases"));
    EXPECT_THAT(refusal_of([&] { database.run("SELECT load_extension('x')"); }),
                HasSubstr("not authorized"));
}

} // namespace
} // namespace macadam::testing
