#pragma once

#include "app/export/tile_pyramid.hpp"
#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "storage/atomic/temp_file.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace macadam {

/// All vector tiles of one version of a database, in an unnamed file: the same bytes as `export`
/// writes. Reading takes a lookup and a read, whatever a tile shows.
class TileSet {
public:
    /// Makes the tiles.
    /// \param beside  in the folder that has room
    /// \throws InputError  on a stop request.
    TileSet(const StoreReader& store,
            std::string version,
            const std::filesystem::path& beside,
            const Progress& progress);

    /// Returns a tile, gzipped; `std::nullopt` if it shows nothing.
    std::optional<std::string> tile(const TileId& id) const;

    const std::string& version() const { return version_; }
    const GeoBox& box() const { return box_; } ///< around all segments with a value
    std::size_t count() const { return places_.size(); }

    static constexpr int min_zoom = 0, max_zoom = 16;

private:
    std::string version_;
    GeoBox box_;
    TempFile file_;
    std::map<TileId, ByteRange> places_;
};

} // namespace macadam
