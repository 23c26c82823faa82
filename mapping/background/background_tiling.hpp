#pragma once

#include "mapping/background/background.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace macadam {

/// Receives packed pieces of a tile (mapping/background/background_pieces.hpp); a tile may come in
/// several parts.
using TakeBackgroundTile = std::function<void(const TileId& tile, std::string_view pieces)>;

/// Cuts features into the tiles of all levels (mapping/background/background_levels.hpp),
/// simplified at each. Holds at most some 32 MB of pieces, which it then gives away.
class BackgroundTiling {
public:
    explicit BackgroundTiling(TakeBackgroundTile take) : take_{std::move(take)} {}

    /// Adds the part of a feature that lies in the tiles around `box`.
    ///
    /// Nothing is added at a level where the pieces of all features would be far more than their
    /// points, which a few areas of continental size could bring about.
    void add(const BackgroundFeature& feature, const GeoBox& box);

    /// Gives away all that is left.
    void finish();

private:
    std::map<TileId, std::string> tiles_;
    std::size_t bytes_ = 0;
    std::size_t points_ = 0;      ///< of all features
    std::size_t whole_tiles_ = 0; ///< tiles that were looked at
    TakeBackgroundTile take_;
};

} // namespace macadam
