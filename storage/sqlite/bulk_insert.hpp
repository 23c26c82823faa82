#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <optional>
#include <string_view>

namespace macadam {

/// Inserts rows into a table many at a time, which takes SQLite half the time of single inserts.
/// Added rows are in the table only after flush().
class BulkInsert {
public:
    /// \param into  "INSERT INTO table"; never user input, because it is not quoted.
    /// \param columns  number of columns of the table, all of which are given; the first is never
    ///                 NULL.
    BulkInsert(Database& database, std::string_view into, int columns);

    template <typename... Values>
    void add(const Values&... values) {
        int position = columns_ * pending_;
        (insert_.bind_at(++position, values), ...);
        if (++pending_ == rows_) {
            run();
        }
    }

    void flush();

private:
    void run();

    int columns_;
    int rows_;
    int pending_ = 0;
    Statement insert_;
};

} // namespace macadam
