#pragma once

#include "app/tiles/tile_drawing.hpp"
#include "estimator/common/geo.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/tiles/tile_archive.hpp"

#include <vector>

namespace macadam {

/// Describes the layers of the vector tiles of a database, from the lowest to the topmost: those of
/// its background, if it has one, then the roads.
std::vector<TileLayer> tile_layers(const StoreReader& store, const TilePlan& plan);

/// Returns the extent in which clients should ask for tiles: with a background, that of all roads.
/// \param measured  box around the segments in the tiles
GeoBox tile_bounds(const StoreReader& store, const GeoBox& measured);

} // namespace macadam
