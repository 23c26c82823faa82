#pragma once

#include "app/tiles/part_level.hpp"
#include "app/tiles/tile_drawing.hpp"
#include "app/tiles/tile_source.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

namespace macadam {

/// Statistics of the tiles made.
struct TileCount {
    std::size_t tiles = 0;
    std::uint64_t largest_bytes = 0;
    std::size_t coarsened = 0; ///< tiles with less detail than others of their zoom
    int max_steps = 0;         ///< maximum coarsening (mapping/tiles/tile_generalisation.hpp)
};

/// Receives one tile at a time, from any thread, in any order.
using PutTile = std::function<void(const TileId&, std::string_view bytes)>;

/// Vector tiles of all zooms of a plan, gzipped. From zoom 14 on they are drawn from segments.
/// Below it they are drawn from generalised parts (mapping/tiles/tile_generalisation.hpp), which
/// are made from those of the four tiles of the next zoom, so that memory does not grow with the
/// database. A part belongs to the tile with the midpoints of its segments and is drawn in every
/// tile it enters.
///
/// Tiles near segments have the background, also those without a segment; a tile that would be too
/// large with it goes without.
///
/// The parts of all zooms are kept on disk, so that a change makes anew only tiles in which it
/// shows. Tiles depend neither on the number of jobs nor on the changes that led to them.
class TilePyramid {
public:
    /// \param beside  in the folder that has room
    TilePyramid(const ClassTable& classes,
                const TilePlan& plan,
                const std::filesystem::path& beside);

    /// Makes the tiles that differ from those of the last call, of which there are none at first.
    ///
    /// \param source   the same, or another one with the same words and background
    /// \param changed  its tiles whose segments have changed
    /// \param put      receives each of them, and others; "": the tile shows nothing
    /// \throws InputError  on a stop request. This is then of no more use.
    TileCount update(const TileSource& source,
                     const std::vector<TileId>& changed,
                     const PutTile& put,
                     const Progress& progress);

private:
    class Update;

    /// Parts by zoom.
    using Levels = std::map<int, PartLevel, std::greater<>>;

    ClassTable classes_;
    TilePlan plan_;
    Levels directed_, both_; ///< of each direction, and of both together
};

/// Makes all tiles of a source.
///
/// \param put  receives each tile that shows something
/// \throws InputError  on a stop request.
TileCount make_vector_tiles(const TileSource& source,
                            const ClassTable& classes,
                            const TilePlan& plan,
                            const PutTile& put,
                            const Progress& progress);

} // namespace macadam
