#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <set>
#include <span>
#include <string>

namespace macadam {

// Drives whose cells lie on other servers. These commit before the front stores the trip, so that
// drives count only if their trip is there. Those of trips that never were are noted by the front
// beforehand, and removed by the next import.

/// Tests whether other servers hold any of these cells, which the transaction shares.
bool are_elsewhere(ServerConnection& front, const std::set<std::int32_t>& cells);

/// Makes a place for rows of table drive that put_drives() distributes. \returns the target of a
/// CopyWriter.
std::string place_for_drives(ServerConnection& front);

/// Stores the rows in the place for drives, each in its cell. Within the caller's transaction, but
/// other servers keep theirs whatever becomes of it.
///
/// \param trips  rows of all their trips
/// \throws ServerTrouble  if a server does not take them, or a standby of it may lack them.
void put_drives(ServerConnection& front, std::span<const std::int64_t> trips);

/// Removes the drives of trips that were not stored, unless they were sent in the last minutes.
void remove_unfinished(ServerConnection& front);

} // namespace macadam
