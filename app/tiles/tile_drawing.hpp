#pragma once

#include "app/tiles/tile_source.hpp"
#include "mapping/style/iri_class.hpp"
#include "render/tiles/mvt_tile.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace macadam {

inline constexpr std::uint64_t max_tile_bytes = 300'000; ///< compressed, as stored

/// Settings that the vector tiles of all zooms share.
struct TilePlan {
    int min_zoom = 6;
    int max_zoom = 16;
    std::size_t jobs = 1;
    std::uint64_t max_bytes = max_tile_bytes;
    TileUnits units = TileUnits::si;
};

/// A vector tile, gzipped.
struct DrawnTile {
    std::string bytes; ///< "": it shows nothing
    int steps = 0;     ///< of coarsening, because it would have been too large
};

/// Parts as coarse as their tile needs.
struct FittedParts {
    std::vector<RoadPart> parts;
    int steps = 0;
};

/// Draws single vector tiles, each with its background unless it would be too large with it. Any
/// thread may draw.
class TileDrawing {
public:
    TileDrawing(const TileSource& source, const ClassTable& classes, const TilePlan& plan)
        : source_{&source}, classes_{&classes}, plan_{&plan} {}

    /// Draws a tile without roads.
    DrawnTile ground(const TileId& tile) const;

    /// Draws single segments, or, if they are too many, the parts of those that belong to the tile.
    DrawnTile segments(const TileId& tile, const std::vector<const TileSegment*>& segments) const;

    /// Draws parts. \param others  parts of other tiles, which are left out of too large a tile
    DrawnTile parts(const TileId& tile,
                    const std::vector<RoadPart>& own,
                    const std::vector<RoadPart>& others) const;

    /// Generalises parts for the zoom of their tile, further until they fit.
    FittedParts fitted(const TileId& tile, std::vector<RoadPart> parts) const;

private:
    VectorTileContext context() const { return {&source_->words, classes_, plan_->units}; }
    std::string with_ground(const TileId& tile, const std::string& roads) const;
    bool fits(const TileId& tile, const std::vector<RoadPart>& parts) const;
    DrawnTile own_parts(const TileId& tile,
                        const std::vector<const TileSegment*>& segments,
                        int steps_before) const;

    const TileSource* source_;
    const ClassTable* classes_;
    const TilePlan* plan_;
};

} // namespace macadam
