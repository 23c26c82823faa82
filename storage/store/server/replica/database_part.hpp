#pragma once

#include "storage/store/records/publication.hpp"
#include "storage/store/server/copy/rows_from_server.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Part of a database on a server: all that an operation reads and changes.
struct DatabasePart {
    std::vector<ServerChunk> chunks; ///< with all their passes, in order

    /// Rows of trips that are held whether or not they drove these chunks.
    std::vector<std::int64_t> trips{};

    /// Trips whose passes over other chunks are held, too, without traces; and these chunks.
    std::vector<std::int64_t> trips_with_all_passes{};
    std::vector<ServerChunk> other_chunks{};

    std::optional<PublishedPart> to_publish{}; ///< if the operation publishes
};

/// Chunks of rows (cell, chunk).
std::vector<ServerChunk> chunks_in(const std::vector<std::int64_t>& numbers);

/// Fills a new file with a part of a database, so that StoreMaintenance does to it there what it
/// would do to the whole.
void fill_database_part(RowsFromServer& rows, Database& file, const DatabasePart& part);

} // namespace macadam
