#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <string>
#include <string_view>

struct sqlite3_value;

namespace macadam {

/// The values of a row that is visited, from column 0; they last until the visit ends.
class VisitedRow {
public:
    explicit VisitedRow(std::span<sqlite3_value* const> values) : values_{values} {}

    std::int64_t integer(int column) const;
    double real(int column) const;
    std::string_view blob(int column) const;
    bool is_null(int column) const;

private:
    std::span<sqlite3_value* const> values_;
};

using VisitRow = std::function<void(const VisitedRow&)>;

/// Teaches a database to visit rows; once, before select_visited() is prepared.
void register_row_callback(Database& database);

/// The beginning of a SELECT, up to its FROM, whose rows are visited instead of given. They come as
/// SQLite finds them: an ORDER BY has no effect.
std::string select_visited(std::string_view columns);

/// Visits rows from inside of SQLite, which reads their values where they lie: two thirds of the
/// time of fetching them one by one.
class RowCallback {
public:
    explicit RowCallback(const VisitRow& visit) : visit_{&visit} {}

    /// \param select  begun by select_visited()
    /// \param values  of its parameters from the second on; the first is taken.
    /// \throws        what `visit` throws.
    template <typename... Values>
    void run(Statement& select, const Values&... values) {
        select.bind(Statement::Pointer{this, pointer_type}, values...);
        finish(select);
    }

private:
    friend struct RowVisitFunction;
    static constexpr const char* pointer_type = "macadam row visits";

    void finish(Statement& select);

    const VisitRow* visit_;
    std::exception_ptr failure_;
};

} // namespace macadam
