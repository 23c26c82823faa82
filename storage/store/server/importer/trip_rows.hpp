#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/records/store_records.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/importer/network_image.hpp"

#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Place where trips are written.
struct TripTarget {
    ServerConnection& server;
    CellDrives& cells; ///< of the same connection
    const ServerSettings& settings;
    StoreConnection& image;             ///< roads of the database
    ImageRows& rows;                    ///< of the same image
    const PrivacyKey* key;              ///< null: the trips name no cars
    std::optional<int> results_version; ///< of the program; `std::nullopt` fits all
};

/// Writes trips with their drives and events, and marks their chunks, in one transaction of four
/// round trips. A trip that is already stored or was forgotten is skipped.
///
/// Rows on which others could wait are taken in one order by all: vehicles, trips, each rising; so
/// nobody waits in a circle. Who drives over the same roads does not wait.
///
/// \returns for each trip whether it is new.
///
/// \throws InputError  also if the roads, the key or the version of results of the database were
///                     changed.
std::vector<bool> write_trips(const TripTarget& target, std::span<const NewTrip> trips);

} // namespace macadam
