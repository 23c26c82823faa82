#pragma once

#include "estimator/common/progress.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/change_recorder.hpp"
#include "storage/store/connection/store_connection.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace macadam {

/// Rows that differ between a replica and its server: keys by table of the replica.
using ChangedRows = std::map<std::string, std::set<RowKey>>;

/// Rows that were changed while a recorder lived, without those of the GeoPackage itself. Of
/// passes and traces, keys are (segment or chunk, trip) without the rest.
ChangedRows changed_rows(const ChangeRecorder& recorder);

/// What a replica holds of its database.
enum class ReplicaExtent : std::uint8_t { all, part };

/// Makes these rows of a server those of the replica, within the caller's transaction.
void write_back(ServerConnection& server,
                StoreConnection& replica,
                const ChangedRows& changed,
                ReplicaExtent extent);

} // namespace macadam
