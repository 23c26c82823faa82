#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/publication.hpp"

#include <cstdint>
#include <optional>

namespace macadam {

/// How far a publication went.
struct PublicationReach {
    std::int64_t last_trip = 0;    ///< row of the last trip that there was
    std::int64_t last_segment = 0; ///< the same of segments: those after it came with a later map
};

/// None if nothing was published yet.
std::optional<Publication> latest_publication(Database& database);

/// Of publication `number`; of none before the first.
PublicationReach reach_of(Database& database, std::int64_t number);

/// Writes the row of a publication over what tables published_state and published_figure hold.
Publication add_publication(Database& database, const std::string& month);

/// From now on this connection reads, in the place of the tables of a store that tell of cars, what
/// the latest publication tells: all else is not there.
void show_published_alone(Database& database);

} // namespace macadam
