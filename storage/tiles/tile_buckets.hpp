#pragma once

#include "mapping/tiles/tile_features.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/atomic/temp_file.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Contents of the tiles of a map, collected by tile.

/// Appends a segment or a road section to the bytes of a tile, in a format for this program only.
void append_to(std::string& bytes, const TileSegment& segment);
void append_to(std::string& bytes, const RoadPart& part);

/// Restores all items that were appended.
std::vector<TileSegment> tile_segments_in(std::string_view bytes);
std::vector<RoadPart> road_parts_in(std::string_view bytes);

/// Byte strings by tile, most of them on disk. The bytes of a tile are returned in insertion order.
/// One thread adds; after settle(), many may read.
class TileBuckets {
public:
    /// \param beside  see TempFile.
    explicit TileBuckets(const std::filesystem::path& beside)
        : temp_file_{std::make_unique<TempFile>(beside)} {}

    /// \param item  appended to the bytes of the tile.
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

    /// Flushes everything to disk.
    void settle();

    /// Replaces the bytes of a tile, "" for none. Call settle() before the first one.
    void put(const TileId& tile, std::string_view bytes);

    /// Gives back the room of replaced bytes once it is more than that of the others.
    void compact();

    /// Tiles that are not empty, in order. Call settle() first.
    std::vector<TileId> tiles() const;

    bool contains(const TileId& tile) const { return places_.contains(tile); }

    /// Bytes of a tile; "" if it is empty.
    std::string read(const TileId& tile) const;

    const std::filesystem::path& beside() const { return temp_file_->beside(); }

private:
    static constexpr std::size_t max_open_bytes = std::size_t{16} << 20U;

    std::unique_ptr<TempFile> temp_file_;
    std::map<TileId, std::string> open_;
    std::size_t open_bytes_ = 0;
    std::map<TileId, std::vector<ByteRange>> places_;
    std::uint64_t replaced_bytes_ = 0;
};

} // namespace macadam
