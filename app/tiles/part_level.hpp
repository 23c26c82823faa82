#pragma once

#include "mapping/tiles/tile_features.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/tiles/tile_buckets.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

namespace macadam {

/// Parts of one zoom by the tile that they belong to, the tiles that they enter, and what has
/// changed of both. One thread at a time sets parts; else many may read.
class PartLevel {
public:
    explicit PartLevel(const std::filesystem::path& beside) : parts_{beside} {}

    /// Replaces the parts of a tile.
    void set(const TileId& tile, const std::vector<RoadPart>& parts);

    std::vector<RoadPart> parts_of(const TileId& tile) const {
        return road_parts_in(parts_.read(tile));
    }

    /// Tests whether parts, also of other tiles, enter a tile.
    bool shows(const TileId& tile) const { return entries_.contains(tile); }

    /// Tiles with parts that differ from those before.
    const std::set<TileId>& changed() const { return changed_; }

    /// Tiles that may look different: where parts of changed tiles are or were, and all beside.
    std::vector<TileId> touched() const;

    /// Forgets what has changed.
    void settle();

private:
    void count_entries(const TileId& tile, int by);

    TileBuckets parts_;
    std::map<TileId, std::set<TileId>> entered_; ///< by the parts of a tile
    std::map<TileId, int> entries_;              ///< number of tiles whose parts enter one
    std::set<TileId> changed_, entered_by_changed_;
};

} // namespace macadam
