#pragma once

#include "storage/postgres/server_connection.hpp"

#include <libpq-fe.h>

#include <memory>
#include <vector>

namespace macadam {

/// Ends the life of a result.
struct ServerResultEnd {
    void operator()(PGresult* result) const { PQclear(result); }
};

/// Result of a statement, as libpq returns it.
using ServerResult = std::unique_ptr<PGresult, ServerResultEnd>;

/// Tests whether a statement did its work.
bool is_done(const PGresult* result);

/// All rows of a result.
std::vector<ServerRow> rows_in(const PGresult* result);

} // namespace macadam
