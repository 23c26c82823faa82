#pragma once

#include "storage/postgres/server_connection.hpp"

namespace macadam {

/// Removes what remove_old_changes() removes from a file (storage/store/rows/old_changes.hpp): of
/// the oldest thousand imports, so that it takes no long time at once. Leaves it to another
/// importer that does so.
void remove_old_changes(ServerConnection& server);

} // namespace macadam
