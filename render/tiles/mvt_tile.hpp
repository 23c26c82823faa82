#pragma once

#include "mapping/tiles/tile_features.hpp"
#include "render/tiles/mvt_layer.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// The layer of every vector tile.
inline constexpr std::string_view roughness_layer = "roughness";

/// A property of the layer's features: its name, and whether it is a number.
struct VectorField {
    std::string name;
    bool is_number;
};

/// What to look words and classes up in, and how much to say.
struct VectorTileContext {
    const TileWords* words;
    const ClassTable* classes;
};

/// Of all zooms: what segments have, and then what parts have beside it
/// (docs/reference/vector-tiles.md).
std::vector<VectorField> vector_fields(const ClassTable& classes);

/// How much a tile says of a segment.
enum class SegmentDetail {
    full,
    less, ///< without the interval, vehicles, first day and trend: for tiles that are too large
};

/// A number that a segment keeps wherever it is drawn; nothing for ways beyond 2^34 or below 0, and
/// for segments beyond 2^18 of one way, which 53 bits cannot tell apart.
std::optional<std::uint64_t> feature_id(const SegmentKey& key);

/// A Mapbox Vector Tile of segments, each a feature of its own, in the order given. "" if the tile
/// shows none.
std::string vector_tile(const TileId& tile,
                        std::span<const TileSegment* const> segments,
                        SegmentDetail detail,
                        const VectorTileContext& context);

/// The same of parts, for zooms at which segments are too small to see.
std::string vector_tile(const TileId& tile,
                        std::span<const RoadPart* const> parts,
                        const VectorTileContext& context);

} // namespace macadam
