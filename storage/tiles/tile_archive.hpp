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

/// Property of the features of a vector layer. TileJSON names its kind "String" or "Number".
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

/// Formats vector layers as the JSON array of TileJSON; "" without any.
std::string layers_json(std::span<const TileLayer> layers);

/// Metadata of an archive.
struct TileSetNote {
    enum class Format { png, mvt }; ///< mvt: Mapbox Vector Tiles, each compressed by gzip
    std::string name;
    std::string description;
    std::string attribution; ///< copyright notice for maps of these tiles
    Format format = Format::mvt;
    GeoBox bounds; ///< extent of the tiles' content
    int min_zoom = 0;
    int max_zoom = 0;
    std::vector<TileLayer> layers; ///< vector tiles only
    int tile_px = 256;             ///< side of image tiles
};

/// Size of the content of an archive.
struct TileArchiveSize {
    std::uint64_t tiles = 0;
    std::uint64_t contents = 0; ///< distinct contents, each stored once
    std::uint64_t bytes = 0;    ///< of the contents
};

/// Writes many tiles into one file, selected by its suffix, or into a folder:
///
/// - `.mbtiles`, an SQLite file (MBTiles specification 1.3; the view `tiles` joins the tables `map`
///   and `images`);
/// - `.pmtiles`, for web servers that only serve byte ranges (PMTiles specification 3; clustered,
///   with leaf directories if the root would exceed 16 kB);
/// - `FOLDER/`, with each tile as a file, `z/x/y.png` or, uncompressed, `z/x/y.pbf`, and the
///   metadata as `metadata.json` (TileJSON specification 3.0).
///
/// Tiles may be added in any order; the output depends only on their contents. They are collected
/// in an unnamed file beside the archive, which takes as much disk space again until commit(), and
/// about 60 bytes of memory per tile. The output appears complete with commit(), or not at all; a
/// folder must be new or empty.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class TileArchive {
public:
    /// \throws InputError  for another suffix, and for a folder that is not empty.
    TileArchive(const std::filesystem::path& place, TileSetNote note);
    TileArchive(const TileArchive&) = delete;
    TileArchive& operator=(const TileArchive&) = delete;
    ~TileArchive();

    /// Adds a tile that was not added before, of a zoom level of the metadata. Not thread-safe.
    ///
    /// \param bytes  at least one.
    void add(const TileId& tile, std::string_view bytes);

    /// Writes the output.
    ///
    /// \throws InputError  if there is no tile, or a stop is requested.
    TileArchiveSize commit(const Progress& progress = {});

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Tests whether the output is a folder: the name ends in a slash, or a folder without an archive
/// suffix exists there.
bool is_tile_folder(const std::filesystem::path& place);

/// Name beside which temporary data lies while an archive is made (storage/atomic/temp_file.hpp).
std::filesystem::path beside_tiles(const std::filesystem::path& place);

/// Suffixes supported by TileArchive.
std::span<const std::string_view> tile_archive_suffixes();

} // namespace macadam
