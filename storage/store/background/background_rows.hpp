#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/background/background.hpp"
#include "mapping/background/background_levels.hpp"
#include "mapping/background/background_pieces.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Contents of a background, for messages.
struct BackgroundSize {
    std::int64_t tiles = 0; ///< rows of tiles
    std::int64_t bytes = 0; ///< of their pieces
    std::int64_t places = 0;
    std::int64_t road_refs = 0;

    bool is_empty() const { return tiles == 0 && places == 0 && road_refs == 0; }
};

/// Returns the box around roads within which their background is kept: maps show some ground beside
/// the outermost ones.
GeoBox background_box(const RoadNetwork& roads);

/// Replaces the background of a database, within a transaction of the caller. Places are stored
/// with the most important first, road numbers only of ways in the database.
///
/// \param box     around the roads: what lies in the tiles that meet it is kept
/// \param source  null: the background is removed
BackgroundSize
replace_background(Database& database, const GeoBox& box, const BackgroundSource& source);

/// \name Conditions, as SQL of any engine, for rows within a box whose east may exceed 180 degrees
/// @{
std::string tiles_in(const GeoBox& box);  ///< of table background: tiles that meet it
std::string places_in(const GeoBox& box); ///< of table place
/// @}

BackgroundSize background_size(Database& database);

/// Reads the tiles of a level that meet a box, in the order of x, y.
///
/// \throws InputError  for a row that is no tile of the level.
std::vector<BackgroundTile>
read_background_tiles(Database& database, const BackgroundLevel& level, const GeoBox& box);

/// Visits all rows of the background in the order of level, x, y, part.
void visit_background_rows(
    Database& database,
    const std::function<void(const TileId& tile, std::int64_t part, std::string_view pieces)>&
        visit);

/// Reads the places within a box, the most important first.
///
/// \throws InputError  for a row that is no place.
std::vector<PlaceName> read_place_names(Database& database, const GeoBox& box);

/// Reads the numbers of roads by way, rising.
std::vector<RoadRef> read_road_refs(Database& database);

} // namespace macadam
