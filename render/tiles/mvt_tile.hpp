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

/// Name of the single layer of every vector tile.
inline constexpr std::string_view roughness_layer = "roughness";

/// Property of the layer's features: its name, and whether it is a number.
struct VectorField {
    std::string name;
    bool is_number;
};

/// Units of properties; those of the United States are part of their names: "iri_in_per_mi".
enum class TileUnits { si, us };

/// Word and class tables of a vector tile.
struct VectorTileContext {
    const TileWords* words;
    const ClassTable* classes;
    TileUnits units = TileUnits::si;
};

/// Returns the properties over all zooms: those of segments, then the additional ones of road parts
/// (docs/reference/vector-tiles.md).
std::vector<VectorField> vector_fields(const ClassTable& classes, TileUnits units = TileUnits::si);

/// Detail of a segment in a tile.
enum class SegmentDetail {
    full,
    less, ///< without interval, vehicles, first day and trend, for tiles that are too large
};

/// Returns a feature number that is constant over all tiles; `std::nullopt` for ways beyond 2^34 or
/// below 0, and for segments beyond 2^18 of one way, which exceed 53 bits.
std::optional<std::uint64_t> feature_id(const SegmentKey& key);

/// Encodes segments as a Mapbox Vector Tile, each a feature of its own, in the order given. "" if
/// the tile shows none.
std::string vector_tile(const TileId& tile,
                        std::span<const TileSegment* const> segments,
                        SegmentDetail detail,
                        const VectorTileContext& context);

/// Encodes road parts, for zooms at which segments are too small to see.
std::string vector_tile(const TileId& tile,
                        std::span<const RoadPart* const> parts,
                        const VectorTileContext& context);

} // namespace macadam
