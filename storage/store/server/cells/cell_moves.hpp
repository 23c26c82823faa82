#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace macadam {

/// Cell of a database on a server.
struct MapCell {
    std::int32_t number; ///< of the quadkey of its map tile
    std::int64_t segments = 0;
    std::string connection{}; ///< of the server that holds its drives; empty: this one
};

/// Lists the cells of a database, rising.
std::vector<MapCell> cells_of(ServerConnection& front);

/// Moves the drives and fused values of a cell to the server behind an address, or, if that is the
/// database's own, back to it, and compares them on both sides. One transaction of the front: on
/// any failure the cell is where it was. Importers that write to the cell wait meanwhile.
///
/// \returns rows moved; 0 if it was there already.
/// \throws InputError  if the database has no such cell, or the role does not own it.
std::int64_t move_cell(ServerConnection& front, std::int32_t cell, const std::string& address);

/// Tables of a cell on another server that are about to be replaced.
struct NextCellTables {
    std::int32_t cell;
    std::int64_t number; ///< of the new ones
};

/// Prepares a generation: copies the tables of cells on their servers, under new names. The role
/// has the places of cells alone, and is the owner of the database or an operator.
///
/// \param changing  cells whose tables may change; `std::nullopt`: all
/// \throws InputError  if an earlier version moved the cells, and the role is not the owner, who
///                     gives operators what they need by any call of move_cell().
std::vector<NextCellTables> prepare_cells(ServerConnection& front,
                                          const std::optional<std::set<std::int32_t>>& changing);

/// Lets the front read and write the new tables, within the caller's transaction: all servers
/// switch with its commit. Waits for those who read them, who do not keep others waiting.
///
/// \throws InputError  after 40 attempts.
void switch_cells(ServerConnection& front, const std::vector<NextCellTables>& next);

/// Removes tables of cells, here and on other servers, that the front does not use: replaced ones,
/// once the standbys have what replaced them, and those of work that was interrupted. The role has
/// the places of cells alone.
///
/// \throws InputError  if a server lost rows of a cell: then all stay.
void drop_unused_cell_tables(ServerConnection& front);

} // namespace macadam
