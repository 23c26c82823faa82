#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/atomic/temp_file.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// All vector tiles of one version of a database, in an unnamed file: the same bytes as `export`
/// writes. Reading takes a lookup and a read, whatever a tile shows.
class TileSet {
public:
    using Places = std::map<TileId, ByteRange>;

    /// \param box     in which there are tiles
    /// \param file    may hold tiles of other versions, too
    TileSet(std::string version,
            std::string layers,
            const GeoBox& box,
            std::shared_ptr<const TempFile> file,
            Places places);

    /// Returns a tile, gzipped; `std::nullopt` if it shows nothing.
    std::optional<std::string> tile(const TileId& id) const;

    const std::string& version() const { return version_; }

    /// Layers of the tiles, as TileJSON describes them.
    const std::string& layers() const { return layers_; }

    /// Box in which there are tiles, of the world if there are none.
    const GeoBox& box() const { return box_; }
    std::size_t count() const { return places_.size(); }

    static constexpr int min_zoom = 0, max_zoom = 16;

private:
    std::string version_;
    std::string layers_;
    GeoBox box_;
    std::shared_ptr<const TempFile> file_;
    Places places_;
};

} // namespace macadam
