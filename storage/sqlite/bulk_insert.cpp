#include "storage/sqlite/bulk_insert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

namespace macadam {
namespace {

constexpr int max_values = 400; // inserting more at once is no faster
constexpr int max_rows = 50;

int rows_of(int columns) {
    return std::clamp(max_values / columns, 1, max_rows);
}

/// Builds the INSERT. Rows whose first value is not bound are skipped.
std::string statement(std::string_view into, int columns) {
    std::string row = "(?";
    for (int i = 1; i < columns; ++i) {
        row += ",?";
    }
    row += ")";
    std::string rows = row;
    for (int i = 1; i < rows_of(columns); ++i) {
        rows += "," + row;
    }
    return fmt::format("{} SELECT * FROM (VALUES {}) WHERE column1 IS NOT NULL", into, rows);
}

} // namespace

BulkInsert::BulkInsert(Database& database, std::string_view into, int columns)
    : columns_{columns}, rows_{rows_of(columns)}, insert_{
                                                      database.prepare(statement(into, columns))} {}

void BulkInsert::flush() {
    if (pending_ > 0) {
        for (; pending_ < rows_; ++pending_) {
            insert_.bind_at(columns_ * pending_ + 1, std::optional<std::int64_t>{});
        }
        run();
    }
}

void BulkInsert::run() {
    insert_.step();
    insert_.reset();
    pending_ = 0;
}

} // namespace macadam
