#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/store/records/maintenance_records.hpp"
#include "storage/store/server/replica/database_part.hpp"

#include <optional>

namespace macadam {

/// Finds the part that a request changes: chunks on which the trips have drives. Of the trips that
/// stay, one of each car that has more is held, and the last one. Within the time in which nobody
/// else writes.
///
/// \returns `std::nullopt` if it changes all, because cars were calibrated by these trips.
std::optional<DatabasePart> part_to_forget(ServerConnection& server, const ForgetRequest& request);

} // namespace macadam
