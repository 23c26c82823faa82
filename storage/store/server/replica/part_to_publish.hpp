#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/replica/database_part.hpp"

#include <optional>

namespace macadam {

/// Finds the part that the next publication may change: the chunks that cars drove since the fourth
/// last publication (pending passes wait for three at most), or since the first one, before which
/// all passes were new; and all passes of who drove there, because the ends of their drives are not
/// published. Within the time in which nobody else writes.
///
/// \returns `std::nullopt` if it may change all: it is the first one, or trips or roads were
///          changed since then.
std::optional<DatabasePart> part_to_publish(ServerConnection& server);

} // namespace macadam
