#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/network/segment.hpp"
#include "mapping/tiles/tile_features.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/tiles/tile_buckets.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Zoom of the tiles by which segments are collected: the last one below single segments.
inline constexpr int source_zoom = 13;

/// Segments of one version of a database, in buckets for the tiles of source_zoom that show them.
struct TileSource {
    explicit TileSource(const std::filesystem::path& beside) : segments{beside} {}

    TileBuckets segments;
    TileWords words;
    GeoBox box;
    std::size_t count = 0; ///< as they were first read

    /// Returns the layers of a tile's background, uncompressed, "" without one. Any thread may call
    /// it. Null: no tile has a background.
    std::function<std::string(const TileId& tile)> background{};
};

/// Adds a segment; settle `source.segments` after the last one.
void add(TileSource& source, const TileSegment& segment);

/// Reads the segments with a state, and opens the background.
/// \param source  must be new
/// \throws InputError  on a stop request.
void read_tile_source(const StoreReader& store,
                      const SegmentFilter& filter,
                      TileSource& source,
                      const Progress& progress);

/// Reads some segments again, of a database whose roads and background are as before.
///
/// \param ranges  of all segments with a new value; they do not overlap
/// \returns       tiles whose segments changed, in order; `std::nullopt`, with a source that is of
///                no more use, if they are too many for this to pay.
/// \throws InputError  on a stop request.
std::optional<std::vector<TileId>> update_tile_source(const StoreReader& store,
                                                      std::vector<SegmentRange> ranges,
                                                      TileSource& source,
                                                      const Progress& progress);

} // namespace macadam
