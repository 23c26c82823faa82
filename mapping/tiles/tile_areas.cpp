#include "mapping/tiles/tile_areas.hpp"

namespace macadam {

WorldBox area_of(const TileId& tile) {
    const auto side = std::uint64_t{1} << static_cast<unsigned>(world_bits - tile.zoom);
    const auto end = [&](std::uint32_t at) {
        return static_cast<std::uint32_t>((at + 1) * side - 1);
    };
    return {static_cast<std::uint32_t>(tile.x * side),
            static_cast<std::uint32_t>(tile.y * side),
            end(tile.x),
            end(tile.y)};
}

TileId child_of(const TileId& tile, unsigned quarter) {
    return {static_cast<std::uint8_t>(tile.zoom + 1),
            2 * tile.x + quarter % 2,
            2 * tile.y + quarter / 2};
}

} // namespace macadam
