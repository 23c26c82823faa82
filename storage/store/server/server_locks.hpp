#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace macadam {

// Advisory locks of a database on a server. A chunk is locked by the number of its first row.

/// Shares the database with other importers until the end of the transaction; waits for who has it
/// alone. A statement of its own, so that later ones see what he wrote.
void share_database(ServerConnection& server);
ServerStatement sharing_database();

/// Takes the database alone, until the end of the connection; waits for all others.
void take_database(ServerConnection& server);

/// \name Cells: map tiles whose drives and fused values may lie on other servers
/// @{

/// Tests whether other servers hold cells of this database.
bool has_cells(ServerConnection& server);
ServerStatement asking_for_cells(); ///< gives 1 or 0

/// Shares cells with who else reads or writes their drives until the end of the transaction; waits
/// for who moves one. Before anything is read from them, so that nobody waits for a cell while he
/// holds what its mover needs.
void share_cells(ServerConnection& server, const std::set<std::int32_t>& cells);
ServerStatement sharing_cells(const std::set<std::int32_t>& cells);

/// Takes a cell alone, until the end of the transaction.
void take_cell(ServerConnection& server, std::int32_t cell);

/// Takes the map of cells to servers alone, until the end of the connection.
void take_cell_places(ServerConnection& server);

/// With cells, makes writers wait before a transaction that is to see one moment of all servers
/// begins, and after it began, opens it on each of them and lets the writers on.
void stop_writers(ServerConnection& server);
void see_all_cells(ServerConnection& server);
/// @}

/// Ends what take_database() began.
void release_database(ServerConnection& server);

/// Number that stands for an import, from its name.
std::int32_t number_of_import(const std::string& name);

/// Shows an import as running until it is released or the connection ends. It excludes nobody.
void take_import_lock(ServerConnection& server, std::int32_t import);
void release_import_lock(ServerConnection& server, std::int32_t import);

/// Takes the removal of old changes until the end of the transaction. \returns false if another
/// connection has it.
bool try_take_old_changes(ServerConnection& server);

/// Takes the deletion of logs whose senders ask for it, in the same way.
bool try_take_deletions(ServerConnection& server);

/// Tests whether another connection imports; with a number, that import.
bool is_other_importing(ServerConnection& server, const std::optional<std::int32_t>& import);

} // namespace macadam
