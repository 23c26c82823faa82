#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/tiles/tile_features.hpp"
#include "render/tiles/mvt_tile.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/tiles/tile_buckets.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace macadam {

inline constexpr std::uint64_t max_tile_bytes = 300'000; ///< compressed, as stored

struct TilePlan {
    int min_zoom = 6;
    int max_zoom = 16;
    std::size_t jobs = 1;
    std::uint64_t max_bytes = max_tile_bytes;
    TileUnits units = TileUnits::si;
};

/// Segments of one version of a database, in buckets for the tiles of zoom 13 that show them.
struct TileSource {
    explicit TileSource(const std::filesystem::path& beside) : segments{beside} {}

    TileBuckets segments;
    TileWords words;
    GeoBox box;
    std::size_t count = 0;

    /// Returns the layers of a tile's background, uncompressed, "" without one. Any thread may call
    /// it. Null: no tile has a background.
    std::function<std::string(const TileId& tile)> background{};
};

/// Adds a segment; settle `source.segments` after the last one.
void add(TileSource& source, const TileSegment& segment);

/// Reads the segments with a state, and opens the background.
/// \param source  must be new
void read_tile_source(const StoreReader& store,
                      const SegmentFilter& filter,
                      TileSource& source,
                      const Progress& progress);

/// Statistics of the tiles made.
struct TileCount {
    std::size_t tiles = 0;
    std::uint64_t largest_bytes = 0;
    std::size_t coarsened = 0; ///< tiles with less detail than others of their zoom
    int max_steps = 0;         ///< maximum coarsening (mapping/tiles/tile_generalisation.hpp)
};

/// Receives one tile at a time, from any thread, in any order.
using PutTile = std::function<void(const TileId&, std::string_view bytes)>;

/// Makes vector tiles of all zooms of the plan, gzipped. From zoom 14 on they are drawn from
/// segments. Below it they are drawn from generalised parts
/// (mapping/tiles/tile_generalisation.hpp), which are made from those of the four tiles of the next
/// zoom, so that memory does not grow with the database. A part belongs to the tile with the
/// midpoints of its segments and is drawn in every tile it enters.
///
/// Tiles near segments have the background, also those without a segment; a tile that would be too
/// large with it goes without.
///
/// Tiles do not depend on the number of jobs.
///
/// \throws InputError  on a stop request.
TileCount make_vector_tiles(const TileSource& source,
                            const ClassTable& classes,
                            const TilePlan& plan,
                            const PutTile& put,
                            const Progress& progress);

} // namespace macadam
