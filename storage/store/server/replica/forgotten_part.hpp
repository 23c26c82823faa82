#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/store/records/maintenance_records.hpp"
#include "storage/store/server/copy/rows_from_server.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Part of a database on a server that changes when it forgets trips.
struct ForgottenPart {
    std::vector<ServerChunk> chunks;   ///< on which they have drives, in order
    std::vector<std::int64_t> leaving; ///< rows of the trips, perhaps with others of like names

    /// Rows of trips that stay: one of each car that has more, and the last one.
    std::vector<std::int64_t> staying;
};

/// Finds the part that a request changes. Within the time in which nobody else writes.
///
/// \returns `std::nullopt` if it changes all, because cars were calibrated by these trips.
std::optional<ForgottenPart> part_to_forget(ServerConnection& server, const ForgetRequest& request);

/// Fills a new file with that part, so that StoreMaintenance::forget() does there what it would do
/// to the whole.
void fill_part_to_forget(RowsFromServer& rows, Database& file, const ForgottenPart& part);

} // namespace macadam
