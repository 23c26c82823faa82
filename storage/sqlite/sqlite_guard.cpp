#include "storage/sqlite/sqlite_guard.hpp"

#include <sqlite3.h>

#include <array>

namespace macadam {
namespace {

struct Setting {
    int option;
    int value;
};

constexpr std::array defences{Setting{SQLITE_DBCONFIG_DEFENSIVE, 1},
                              Setting{SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                              Setting{SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
                              Setting{SQLITE_DBCONFIG_ENABLE_FTS3_TOKENIZER, 0},
                              Setting{SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                              Setting{SQLITE_DBCONFIG_ENABLE_VIEW, 0},
                              Setting{SQLITE_DBCONFIG_WRITABLE_SCHEMA, 0}};

/// Limits far above the needs of our own statements (https://sqlite.org/limits.html).
constexpr std::array limits{Setting{SQLITE_LIMIT_LENGTH, 512 << 20}, // a value, or a row
                            Setting{SQLITE_LIMIT_SQL_LENGTH, 1'000'000},
                            Setting{SQLITE_LIMIT_COLUMN, 100},
                            Setting{SQLITE_LIMIT_EXPR_DEPTH, 200},
                            Setting{SQLITE_LIMIT_COMPOUND_SELECT, 20},
                            Setting{SQLITE_LIMIT_VDBE_OP, 250'000},
                            Setting{SQLITE_LIMIT_FUNCTION_ARG, 64},
                            Setting{SQLITE_LIMIT_ATTACHED, 0},
                            Setting{SQLITE_LIMIT_VARIABLE_NUMBER, 1000},
                            Setting{SQLITE_LIMIT_TRIGGER_DEPTH, 8},
                            Setting{SQLITE_LIMIT_WORKER_THREADS, 0}};

} // namespace

void guard_from_others(sqlite3* database) {
    for (const auto& [option, value] : defences) {
        sqlite3_db_config(database, option, value, nullptr);
    }
    for (const auto& [limit, value] : limits) {
        sqlite3_limit(database, limit, value);
    }
}

} // namespace macadam
