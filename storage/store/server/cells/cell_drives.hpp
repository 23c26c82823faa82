#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

namespace macadam {

// Drives whose cells lie on other servers. These commit before the front stores the trip, so that
// drives count only if their trip is there. Those of trips that never were are noted by the front
// beforehand, and removed by the next import.

/// Cells that other servers hold, of a front.
std::set<std::int32_t> cells_elsewhere(ServerConnection& front);

/// Tests whether other servers hold any of these cells, which the transaction shares.
bool are_elsewhere(ServerConnection& front, const std::set<std::int32_t>& cells);

/// Writes drives of new trips to the servers of their cells.
class CellDrives {
public:
    explicit CellDrives(ServerConnection& front) : front_{&front} {}

    /// Makes a place for rows of table drive. \returns the target of a CopyWriter.
    std::string place();

    /// Stores the rows in that place, each in its cell. Within a transaction of the front, but
    /// other servers keep theirs whatever becomes of it.
    ///
    /// \param trips  rows of all their trips
    /// \throws ServerTrouble  if a server does not take them, or a standby of it may lack them.
    void put(std::span<const std::int64_t> trips);

private:
    void note(const std::string& trips, std::size_t count);

    ServerConnection* front_;
    std::optional<ServerConnection> notes_; ///< for transactions beside that of front_
};

/// Waits until standbys of other servers that hold any of these cells have what was committed
/// there: postgres_fdw does not tell of a commit that ended without. Nothing on a front whose first
/// cell moved before this existed.
///
/// \throws ServerTrouble  if a server does not answer, or a standby of it may lack something.
void await_standbys(ServerConnection& front, const std::set<std::int32_t>& cells);

/// Removes the drives of trips that were not stored, unless they were sent in the last minutes.
void remove_unfinished(ServerConnection& front);

} // namespace macadam
