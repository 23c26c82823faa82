#include "hostile_database.hpp"

#include "support/program/program.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t page_bytes = 4096;

constexpr std::array<std::string_view, 20> hostile_values{
    "NULL",
    "''",
    "'x'",
    "-1",
    "0",
    "1",
    "2147483648",
    "9223372036854775807",
    "-9223372036854775808",
    "1e308",
    "-1e308",
    "9e999",
    "zeroblob(0)",
    "zeroblob(1000)",
    "zeroblob(20000000)",
    "x'ffffffffffffffffffffffffffffffff'",
    "char(0, 27, 91, 51, 49, 109)", // colours a terminal
    "'<script>alert(1)</script>'",
    "'../../../etc/passwd'",
    "printf('%.*c', 1000000, 'x')"};

class Dice {
public:
    explicit Dice(std::uint64_t start) : random_{start} {}

    std::size_t below(std::size_t past) { return past == 0 ? 0 : random_() % past; }
    char byte() { return static_cast<char>(random_()); }

    template <typename Values>
    const auto& one_of(const Values& values) {
        return values[below(values.size())];
    }

private:
    std::mt19937_64 random_;
};

// --------------------------------------------------------------------------------------- bytes

std::string spoil_bytes(const fs::path& file, Dice& dice) {
    auto content = read_file(file);
    const auto count = 1 + dice.below(40);
    for (std::size_t i = 0; i < count; ++i) {
        const auto page = dice.below(content.size() / page_bytes) * page_bytes;
        // headers of pages are where it hurts
        const auto at = page + (dice.below(2) == 0 ? dice.below(16) : dice.below(page_bytes));
        content[at] = dice.byte();
    }
    write_file(file, content);
    return std::to_string(count) + " bytes";
}

std::string spoil_pages(const fs::path& file, Dice& dice) {
    auto content = read_file(file);
    const auto pages = content.size() / page_bytes;
    const auto from = dice.below(pages);
    const auto to = 1 + dice.below(pages - 1); // the first has the header
    content.replace(to * page_bytes, page_bytes, content.substr(from * page_bytes, page_bytes));
    write_file(file, content);
    return "page " + std::to_string(from) + " over page " + std::to_string(to);
}

std::string spoil_length(const fs::path& file, Dice& dice) {
    const auto size = fs::file_size(file);
    const auto length = dice.below(3) == 0 ? size + dice.below(1 << 20) : dice.below(size);
    fs::resize_file(file, length);
    return "length " + std::to_string(length);
}

std::string spoil_journals(const fs::path& file, Dice& dice) {
    const auto content = read_file(file);
    std::string journal;
    const bool is_wal = dice.below(2) == 0;
    if (is_wal) {
        journal = std::string{"\x37\x7f\x06\x82\x00\x2d\xe2\x18\x00\x00\x10\x00", 12};
    } else {
        journal = std::string{"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7\xff\xff\xff\xff", 12};
    }
    for (std::size_t i = 0; i < 500; ++i) {
        journal += dice.byte();
    }
    journal += content.substr(0, dice.below(content.size()));
    write_file(file.string() + (is_wal ? "-wal" : "-journal"), journal);
    return is_wal ? "a write-ahead log" : "a journal";
}

// ----------------------------------------------------------------------------------------- SQL

struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
using Database = std::unique_ptr<sqlite3, Close>;

Database opened(const fs::path& file) {
    sqlite3* handle = nullptr;
    if (sqlite3_open(file.c_str(), &handle) != SQLITE_OK) {
        throw std::runtime_error{"cannot open the database to spoil"};
    }
    return Database{handle};
}

/// As far as SQLite lets it; what it refuses is not there.
std::string run_sql(const Database& database, const std::string& sql) {
    sqlite3_exec(database.get(), sql.c_str(), nullptr, nullptr, nullptr);
    return sql;
}

std::vector<std::string> texts(const Database& database, const std::string& sql) {
    std::vector<std::string> found;
    sqlite3_exec(
        database.get(),
        sql.c_str(),
        [](void* into, int, char** values, char**) {
            static_cast<std::vector<std::string>*>(into)->emplace_back(values[0]);
            return 0;
        },
        &found,
        nullptr);
    return found;
}

std::vector<std::string> tables(const Database& database) {
    return texts(database,
                 "SELECT name FROM sqlite_schema WHERE type = 'table' AND sql NOT LIKE "
                 "'CREATE VIRTUAL%' AND name NOT LIKE 'sqlite_%' ORDER BY name");
}

std::string column_of(const Database& database, const std::string& table, Dice& dice) {
    const auto columns = texts(database, "SELECT name FROM pragma_table_info('" + table + "')");
    return columns.empty() ? "rowid" : dice.one_of(columns);
}

std::string spoil_cells(const Database& database, bool all_rows, Dice& dice) {
    std::string done;
    const auto count = 1 + dice.below(3);
    for (std::size_t i = 0; i < count; ++i) {
        const auto table = dice.one_of(tables(database));
        const auto rows =
            all_rows ? std::string{} : " WHERE rowid % 7 = " + std::to_string(dice.below(7));
        done += run_sql(database,
                        "UPDATE OR REPLACE \"" + table + "\" SET \"" +
                            column_of(database, table, dice) +
                            "\" = " + std::string{dice.one_of(hostile_values)} + rows + "; ");
    }
    return done;
}

std::string spoil_blobs(const Database& database, Dice& dice) {
    std::string done;
    const auto all = tables(database);
    for (std::size_t i = 0; i < 6; ++i) {
        const auto table = dice.one_of(all);
        const auto column = '"' + column_of(database, table, dice) + '"';
        const auto at = std::to_string(1 + dice.below(64));
        done += run_sql(database,
                        "UPDATE \"" + table + "\" SET " + column + " = CAST(substr(" + column +
                            ", 1, " + at + ") || x'ffffff7f' || substr(" + column + ", " + at +
                            " + 4) AS BLOB) WHERE typeof(" + column + ") = 'blob'; ");
    }
    return done;
}

std::string spoil_schema(const Database& database, Dice& dice) {
    const auto table = dice.one_of(tables(database));
    const auto named = '"' + table + '"';
    const std::string endless =
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT ";
    switch (dice.below(8)) {
    case 0:
        return run_sql(database, "DROP TABLE " + named);
    case 1:
        return run_sql(database,
                       "ALTER TABLE " + named + " RENAME TO hidden; CREATE VIEW " + named +
                           " AS SELECT * FROM hidden");
    case 2:
        return run_sql(database,
                       "DROP TABLE " + named + "; CREATE VIEW " + named + " AS " + endless +
                           "* FROM n");
    case 3:
        return run_sql(database,
                       "CREATE TRIGGER t AFTER INSERT ON " + named + " BEGIN INSERT INTO " + named +
                           " SELECT * FROM " + named + "; END");
    case 4:
        return run_sql(database,
                       "ALTER TABLE " + named + " DROP COLUMN \"" +
                           column_of(database, table, dice) + '"');
    case 5:
        return run_sql(database,
                       "ALTER TABLE " + named + " ADD COLUMN more AS (zeroblob(1000000000))");
    case 6: {
        const auto indices = texts(database,
                                   "SELECT name FROM sqlite_schema WHERE type = 'index' AND sql "
                                   "IS NOT NULL ORDER BY name");
        return indices.empty() ? "no index"
                               : run_sql(database, "DROP INDEX \"" + dice.one_of(indices) + '"');
    }
    default:
        return run_sql(database,
                       "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET rootpage = " +
                           std::to_string(dice.below(60)) + " WHERE name = '" + table + "'");
    }
}

std::string spoil_masses(const Database& database, Dice& dice) {
    const auto table = dice.one_of(tables(database));
    const auto columns = texts(database, "SELECT name FROM pragma_table_info('" + table + "')");
    std::string values;
    for (const auto& column : columns) {
        const bool is_key = column == columns.front();
        values += (values.empty() ? "" : ", ") +
                  (is_key ? std::string{"1000 + i"} : "\"" + column + "\"");
    }
    return run_sql(database,
                   "INSERT OR IGNORE INTO \"" + table +
                       "\" WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT "
                       "100000) SELECT " +
                       values + " FROM n, (SELECT * FROM \"" + table + "\" LIMIT 1)");
}

} // namespace

std::string spoil(const fs::path& file, Spoiling way, std::uint64_t number) {
    Dice dice{number * 16 + static_cast<std::uint64_t>(way)};
    switch (way) {
    case Spoiling::bytes:
        return spoil_bytes(file, dice);
    case Spoiling::pages:
        return spoil_pages(file, dice);
    case Spoiling::length:
        return spoil_length(file, dice);
    case Spoiling::journals:
        return spoil_journals(file, dice);
    default:
        break;
    }
    const auto database = opened(file);
    run_sql(database, "PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON");
    switch (way) {
    case Spoiling::cells:
        return spoil_cells(database, false, dice);
    case Spoiling::columns:
        return spoil_cells(database, true, dice);
    case Spoiling::blobs:
        return spoil_blobs(database, dice);
    case Spoiling::schema:
        return spoil_schema(database, dice);
    default:
        return spoil_masses(database, dice);
    }
}

} // namespace macadam::testing
