#include "storage/postgres/server_result.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace macadam {

bool is_done(const PGresult* result) {
    const auto status = PQresultStatus(result);
    return status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK;
}

std::vector<ServerRow> rows_in(const PGresult* result) {
    std::vector<ServerRow> rows(static_cast<std::size_t>(PQntuples(result)));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (int column = 0; column < PQnfields(result); ++column) {
            const int row = static_cast<int>(i);
            rows[i].push_back(PQgetisnull(result, row, column) != 0
                                  ? std::nullopt
                                  : std::optional{std::string(PQgetvalue(result, row, column),
                                                              static_cast<std::size_t>(PQgetlength(
                                                                  result, row, column)))});
        }
    }
    return rows;
}

} // namespace macadam
