#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

struct sqlite3_session;

namespace macadam {

/// Values of the columns of a primary key, in the order of the table's columns, as text.
using RowKey = std::vector<std::string>;

/// Records which rows of the main database its connection inserts, changes and deletes, until it
/// is destroyed. Takes memory in proportion to these rows.
///
/// Source: the session extension of SQLite, https://sqlite.org/sessionintro.html.
class ChangeRecorder {
public:
    /// \throws InputError  if this SQLite was built without that extension.
    explicit ChangeRecorder(Database& database);

    /// Visits the keys of the rows that are not as they were at the begin, in no order.
    void visit(const std::function<void(const std::string& table, const RowKey& key)>& visit) const;

private:
    struct Delete {
        void operator()(sqlite3_session* session) const;
    };
    Database* database_;
    std::unique_ptr<sqlite3_session, Delete> session_;
};

} // namespace macadam
