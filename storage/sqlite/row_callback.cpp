#include "storage/sqlite/row_callback.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <utility>

namespace macadam {

std::int64_t VisitedRow::integer(int column) const {
    return sqlite3_value_int64(values_[static_cast<std::size_t>(column)]);
}

double VisitedRow::real(int column) const {
    return sqlite3_value_double(values_[static_cast<std::size_t>(column)]);
}

std::string_view VisitedRow::blob(int column) const {
    auto* const value = values_[static_cast<std::size_t>(column)];
    const auto* bytes = static_cast<const char*>(sqlite3_value_blob(value));
    const auto size = static_cast<std::size_t>(sqlite3_value_bytes(value));
    return bytes == nullptr ? std::string_view{} : std::string_view{bytes, size};
}

bool VisitedRow::is_null(int column) const {
    return sqlite3_value_type(values_[static_cast<std::size_t>(column)]) == SQLITE_NULL;
}

/// Aggregate function whose result is unused. Exceptions must not pass through SQLite.
struct RowVisitFunction {
    static constexpr const char* name = "visit_row";

    static void take(sqlite3_context* context, int count, sqlite3_value** values) noexcept {
        auto* const visits = count == 0 ? nullptr
                                        : static_cast<RowCallback*>(sqlite3_value_pointer(
                                              values[0], RowCallback::pointer_type));
        if (visits == nullptr) {
            sqlite3_result_error(context, "visit_row is for macadam alone", -1);
            return;
        }
        try {
            (*visits->visit_)(VisitedRow{{values + 1, static_cast<std::size_t>(count - 1)}});
        } catch (...) {
            visits->failure_ = std::current_exception();
            sqlite3_result_error(context, "a visit has failed", -1);
        }
    }

    static void end(sqlite3_context* /*context*/) noexcept {}
};

void register_row_callback(Database& database) {
    constexpr int any_count = -1;
    sqlite3_create_function_v2(database.handle(),
                               RowVisitFunction::name,
                               any_count,
                               SQLITE_UTF8 | SQLITE_DIRECTONLY,
                               nullptr,
                               nullptr,
                               RowVisitFunction::take,
                               RowVisitFunction::end,
                               nullptr);
}

std::string select_visited(std::string_view columns) {
    return fmt::format("SELECT {}(?1, {})", RowVisitFunction::name, columns);
}

void RowCallback::finish(Statement& select) {
    try {
        select.step();
    } catch (...) {
        if (failure_) {
            std::rethrow_exception(std::exchange(failure_, nullptr));
        }
        throw;
    }
}

} // namespace macadam
