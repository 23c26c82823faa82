#pragma once

#include "mapping/tiles/tile_grid.hpp"
#include "storage/atomic/temp_file.hpp"
#include "storage/tiles/tile_archive.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Tile and the index of its content.
struct TileEntry {
    std::uint64_t number; ///< see tile_number
    TileId tile;
    std::uint32_t content;
};

/// Position of a tile among all tiles: zoom level by zoom level, each along a Hilbert curve, so
/// that neighbours lie close together. The tile of zoom 0 has number 0.
///
/// Source: PMTiles specification, version 3, 4.1.1; the curve of D. Hilbert as in J. K. Lawder,
/// "Calculation of mappings between one and n-dimensional values using the Hilbert space-filling
/// curve", Birkbeck College (2000).
std::uint64_t tile_number(const TileId& tile);

/// Collects the tiles and stores each distinct content once. After sort(), tiles are in the order
/// of their numbers, and contents are numbered by first appearance.
class TileIndex {
public:
    explicit TileIndex(const std::filesystem::path& beside) : temp_file_{beside} {}

    void add(const TileId& tile, std::string_view bytes);

    /// Sorts the tiles. Call it after the last add() and before the functions below.
    void sort();

    const std::vector<TileEntry>& entries() const { return entries_; }
    std::size_t count() const { return places_.size(); }
    std::uint32_t size_of(std::size_t content) const { return places_[content].size; }
    std::string bytes_of(std::size_t content) const { return temp_file_.read(places_[content]); }
    std::uint64_t bytes() const { return temp_file_.size(); }

private:
    std::uint32_t content_of(std::string_view bytes);

    TempFile temp_file_;
    std::vector<TileEntry> entries_;
    std::vector<ByteRange> places_;
    std::unordered_multimap<std::size_t, std::uint32_t> by_hash_;
};

void write_mbtiles(const std::filesystem::path& temporary,
                   const std::filesystem::path& file,
                   const TileIndex& contents,
                   const TileSetNote& note,
                   const Progress& progress);

class AtomicFile;
void write_pmtiles(AtomicFile& out,
                   const TileIndex& contents,
                   const TileSetNote& note,
                   const Progress& progress);

/// \param temporary  folder to write
/// \param called  final name of the folder
void write_tile_folder(const std::filesystem::path& temporary,
                       const std::filesystem::path& called,
                       const TileIndex& contents,
                       const TileSetNote& note,
                       const Progress& progress);

/// Initial view: the centre, at the highest zoom level at which the extent is at most two tiles
/// wide.
struct TileSetCentre {
    GeoPoint place;
    int zoom;
};
TileSetCentre centre_of(const TileSetNote& note);

} // namespace macadam
