#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// A property of a vector layer's features, as TileJSON names its kind: "String" or "Number".
struct TileField {
    std::string name;
    std::string kind;
};

struct TileLayer {
    std::string id;
    std::string description;
    int min_zoom = 0;
    int max_zoom = 0;
    std::vector<TileField> fields;
};

/// What an archive says of its tiles.
struct TileSetNote {
    enum class Format { png, mvt }; ///< mvt: Mapbox Vector Tiles, each compressed by gzip
    std::string name;
    std::string description;
    std::string attribution; ///< whom a map of these tiles must name
    Format format = Format::mvt;
    GeoBox bounds; ///< of what the tiles show
    int min_zoom = 0;
    int max_zoom = 0;
    std::vector<TileLayer> layers; ///< of vector tiles
    int tile_px = 256;             ///< side of pictures
};

/// How much an archive holds.
struct TileArchiveSize {
    std::uint64_t tiles = 0;
    std::uint64_t contents = 0; ///< different ones; each is stored once
    std::uint64_t bytes = 0;    ///< of the contents
};

/// Many tiles in one file, by its suffix, or in a folder:
/// `.mbtiles`, an SQLite file (MBTiles specification 1.3; the view `tiles` stands over the tables
/// `map` and `images`), or `.pmtiles`, for web servers that only hand out parts of files (PMTiles
/// specification 3; clustered, with leaf directories where the root would be over 16 kB);
/// `FOLDER/` with each tile as a file of its own, `z/x/y.png` or, not compressed, `z/x/y.pbf`, and
/// what the archives say of their tiles as `metadata.json` (TileJSON specification 3.0).
///
/// Tiles come in any order; the file's bytes depend only on what they are. They are laid aside in a
/// nameless file beside the archive, which takes as much room again until commit(), and
/// about 60 bytes of memory a tile. What is made appears whole with commit(), or not at all; a
/// folder is new or was empty.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class TileArchive {
public:
    /// \throws InputError  for another suffix, and for a folder that has something in it.
    TileArchive(const std::filesystem::path& place, TileSetNote note);
    TileArchive(const TileArchive&) = delete;
    TileArchive& operator=(const TileArchive&) = delete;
    ~TileArchive();

    /// A tile that is not there yet, of a zoom of the note. \param bytes  at least one.
    /// Not for two threads at a time.
    void add(const TileId& tile, std::string_view bytes);

    /// \throws InputError  if there is no tile, or a stop is wanted.
    TileArchiveSize commit(const Progress& progress = {});

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Whether tiles go into a folder there: its name ends in a slash, or it is there.
bool is_tile_folder(const std::filesystem::path& place);

/// A name for what is laid aside while an archive is made (storage/atomic/temp_file.hpp).
std::filesystem::path beside_tiles(const std::filesystem::path& place);

/// Suffixes that a TileArchive knows.
std::span<const std::string_view> tile_archive_suffixes();

} // namespace macadam
