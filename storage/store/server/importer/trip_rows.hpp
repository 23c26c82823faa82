#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/records/store_records.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/importer/network_image.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Writes trips with their drives and events, and marks their chunks, within the caller's
/// transaction. A trip that is already stored or was forgotten is skipped.
///
/// Rows on which others could wait are taken in one order by all: vehicles, trips, chunks, each
/// rising; so nobody waits in a circle.
///
/// \param cells  of the same connection
/// \param key  null: the trips name no cars.
/// \returns for each trip whether it is new.
std::vector<bool> write_trips(ServerConnection& server,
                              CellDrives& cells,
                              const StoreConnection& image,
                              ImageRows& rows,
                              const PrivacyKey* key,
                              std::span<const NewTrip> trips);

} // namespace macadam
