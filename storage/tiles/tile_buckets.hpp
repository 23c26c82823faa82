#pragma once

#include "mapping/tiles/tile_features.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/atomic/temp_file.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// What goes into the tiles of a map, laid aside tile by tile while it is sorted.

/// A segment or a part as bytes for the same program, added to those that are there.
void append_to(std::string& bytes, const TileSegment& segment);
void append_to(std::string& bytes, const RoadPart& part);

/// All that were added.
std::vector<TileSegment> tile_segments_in(std::string_view bytes);
std::vector<RoadPart> road_parts_in(std::string_view bytes);

/// Bytes by tile, most of them on disk. Those of one tile come back in the order in which they were
/// added. One thread adds; after settle() many may read.
class TileBuckets {
public:
    /// \param beside  see Spool.
    explicit TileBuckets(const std::filesystem::path& beside) : spool_{beside} {}

    /// \param add  appends to what the tile has.
    template <typename Item>
    void add(const TileId& tile, const Item& item) {
        auto& bytes = open_[tile];
        const auto before = bytes.size();
        append_to(bytes, item);
        open_bytes_ += bytes.size() - before;
        if (open_bytes_ > max_open_bytes) {
            settle();
        }
    }

    /// Brings all to disk.
    void settle();

    /// Those that hold something, in order. After settle().
    std::vector<TileId> tiles() const;

    /// "" for a tile that holds nothing.
    std::string read(const TileId& tile) const;

    const std::filesystem::path& beside() const { return spool_.beside(); }

private:
    static constexpr std::size_t max_open_bytes = std::size_t{16} << 20U;

    TempFile spool_;
    std::map<TileId, std::string> open_;
    std::size_t open_bytes_ = 0;
    std::map<TileId, std::vector<ByteRange>> places_;
};

} // namespace macadam
