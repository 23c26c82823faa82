#pragma once

#include "estimator/common/progress.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/server_rows.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace macadam {

/// Computes the digest of a database on a server, the same as digest_of() of a file with the same
/// content. Consistent only within a transaction. Memory holds one chunk at a time.
///
/// \param chunks  only these, as of a database with nothing else; `std::nullopt`: all
std::string digest_of_server(ServerConnection& server,
                             std::uint32_t segments_per_chunk,
                             const Progress& progress,
                             const std::optional<std::span<const ServerChunk>>& chunks = {});

} // namespace macadam
