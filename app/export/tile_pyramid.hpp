#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/tiles/tile_features.hpp"
#include "storage/store/road_store.hpp"
#include "storage/tiles/tile_buckets.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace macadam {

inline constexpr std::uint64_t max_tile_bytes = 300'000; ///< compressed, as they are stored

struct TilePlan {
    int min_zoom = 6;
    int max_zoom = 16;
    std::size_t jobs = 1;
    std::uint64_t max_bytes = max_tile_bytes;
};

/// Segments of one moment of a store, laid aside by the tiles of zoom 13 that show them.
struct TileSource {
    explicit TileSource(const std::filesystem::path& beside) : segments{beside} {}

    TileBuckets segments;
    TileWords words;
    GeoBox box;
    std::size_t count = 0;
};

/// Lays a segment aside; after the last one `source.segments` is to be settled.
void add(TileSource& source, const TileSegment& segment);

/// Reads the segments with a state. \param source  a new one.
void read_tile_source(const RoadStore& store,
                      const SegmentFilter& filter,
                      TileSource& source,
                      const Progress& progress);

/// What became of them.
struct TileCount {
    std::size_t tiles = 0;
    std::uint64_t largest_bytes = 0;
    std::size_t coarsened =
        0;             ///< tiles that say less than others of their zoom: too much lies there
    int max_steps = 0; ///< of coarsening (mapping/tiles/tile_generalisation.hpp)
};

/// Called for one tile at a time, from any thread, in any order.
using PutTile = std::function<void(const TileId&, std::string_view bytes)>;

/// Vector tiles of all zooms of the plan, gzipped. From zoom 14 on they are drawn from segments;
/// below it from parts (mapping/tiles/tile_generalisation.hpp) that are made of those of the four
/// tiles of the next zoom, so that memory does not grow with the store. A part belongs to the tile
/// that holds the middles of its segments, and is drawn in every tile that it comes into.
///
/// A tile is the same whatever the number of jobs.
///
/// \throws InputError  if a stop is wanted.
TileCount make_vector_tiles(const TileSource& source,
                            const ClassTable& classes,
                            const TilePlan& plan,
                            const PutTile& put,
                            const Progress& progress);

} // namespace macadam
