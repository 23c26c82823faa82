#pragma once

#include "app/serve/live/tile_set.hpp"
#include "app/tiles/tile_pyramid.hpp"
#include "app/tiles/tile_source.hpp"
#include "estimator/common/progress.hpp"
#include "storage/atomic/temp_file.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/records/store_moment.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace macadam {

/// Makes the tiles of one version of a database after the other: after the first, only those that
/// differ from the version before.
class TileMaker {
public:
    /// \param beside  in the folder that has room
    explicit TileMaker(std::filesystem::path beside) : beside_{std::move(beside)} {}

    /// Makes the tiles of what a database shows now.
    ///
    /// \param store  the same file as before, unless forget() was called since
    /// \throws InputError  on a stop request; the next call makes all.
    std::shared_ptr<const TileSet>
    make(const StoreReader& store, const std::string& version, const Progress& progress);

    /// Tests whether only trips have come since the last call.
    bool can_update(const StoreReader& store) const {
        return made_ && store.changed_since(made_->moment);
    }

    /// Has the next call make all tiles.
    void forget() { made_.reset(); }

    /// Number of tiles that the last call made.
    std::size_t made() const { return made_tiles_; }

private:
    /// Tiles of one version, on which the next one builds.
    struct Made {
        Made(const ClassTable& classes, const std::filesystem::path& beside);

        StoreMoment moment;
        TileSource source;
        TilePyramid pyramid;
        std::shared_ptr<TempFile> file;
        TileSet::Places places;
        std::uint64_t bytes = 0; ///< of the places
    };

    std::vector<TileId> read(const StoreReader& store, const Progress& progress);
    void compact();

    std::filesystem::path beside_;
    std::unique_ptr<Made> made_;
    std::size_t made_tiles_ = 0;
};

} // namespace macadam
