#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/records/publication.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Extent of the data considered by a publication.
struct PublicationReach {
    std::int64_t last_trip = 0; ///< row of the last trip at that time
    std::int64_t last_segment =
        0; ///< row of the last segment at that time; later rows belong to a newer map
    std::int64_t number = 0; ///< of the publication
};

/// Latest publication; `std::nullopt` if nothing was published yet.
std::optional<Publication> latest_publication(Database& database);

/// Extent of publication `number`; zero for 0, before the first.
PublicationReach reach_of(Database& database, std::int64_t number);

/// Extents of all publications.
std::vector<PublicationReach> reaches_of_all(Database& database);

/// Shadows all tables with data of cars for this connection: from now on it reads only the latest
/// publication.
void show_published_alone(Database& database);

} // namespace macadam
