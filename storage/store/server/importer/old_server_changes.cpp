#include "storage/store/server/importer/old_server_changes.hpp"

#include "storage/store/rows/old_changes.hpp"
#include "storage/store/server/server_locks.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {
namespace {

constexpr const char* oldest_import =
    "SELECT count(*) FROM (SELECT at FROM macadam.audit WHERE what = 'import' ORDER BY id LIMIT 1)"
    " AS oldest WHERE at < $1";

/// Row of the audit before which changes go.
constexpr const char* first_to_keep =
    "SELECT coalesce(max(id), 0) + 1 FROM (SELECT id FROM macadam.audit WHERE what = 'import'"
    " AND id < coalesce((SELECT id FROM macadam.audit WHERE at >= $1 ORDER BY id LIMIT 1),"
    " 9223372036854775807) ORDER BY id LIMIT 1000) AS old";

} // namespace

void remove_old_changes(ServerConnection& server) {
    const auto since = changes_kept_since();
    if (server.numbers(oldest_import, {since}).at(0) == 0) {
        return;
    }
    ServerTransaction all{server};
    share_database(server);
    if (try_take_old_changes(server)) {
        const ServerStatement::Values first{
            std::to_string(server.numbers(first_to_keep, {since}).at(0))};
        server.rows("DELETE FROM macadam.state_change WHERE audit < $1", first);
        server.rows("DELETE FROM macadam.audit WHERE what = 'import' AND id < $1", first);
    }
    all.commit();
}

} // namespace macadam
