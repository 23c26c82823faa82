#pragma once

#include "app/serve/live/picture_tiles.hpp"
#include "app/serve/live/tile_set.hpp"
#include "app/serve/ogc/api_context.hpp"

#include <string>
#include <vector>

namespace macadam {

// OGC API - Tiles (OGC 20-057) of vector tiles, and below /map/ of picture tiles, in
// WebMercatorQuad (OGC 17-083r2, annex D.1). Without tiles, while the first are made, each answers
// 503.

/// Tile sets of the dataset, or of the collection of segments.
HttpResponse tile_sets_page(const ApiContext& context, const TileSet* tiles);

/// Metadata of a tile set, with the template of its tiles' addresses.
/// \throws UsageError  for a bad parameter
HttpResponse
tile_set_page(const ApiContext& context, const TileSet* tiles, const std::string& matrix_set);

/// Tests whether a request is for a picture tile, which takes its time to draw.
bool is_for_picture_tile(const HttpRequest& request);

/// The tile; 204 if it shows nothing, 404 outside of the matrix.
/// \param pictures  draw what is_for_picture_tile()
HttpResponse tile_response(const ApiContext& context,
                           const TileSet* tiles,
                           PictureTiles& pictures,
                           const std::string& matrix_set,
                           const std::vector<std::string>& zoom_row_column);

/// TileJSON 3.0.
HttpResponse tile_json_page(const ApiContext& context, const TileSet* tiles);

/// List of the matrix sets, and the definition of one.
HttpResponse matrix_sets_page(const ApiContext& context);
HttpResponse matrix_set_page(const ApiContext& context, const std::string& matrix_set);

} // namespace macadam
