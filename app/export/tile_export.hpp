#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/parallel/jobs_option.hpp"
#include "app/tiles/tile_pyramid.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace macadam {

inline constexpr Option zoom_option =
    in_group("tiles",
             {"--zoom",
              "A-B",
              "Tiles: zoom levels, from 0 to 18 (single segments appear from zoom 14).",
              "6-16"});
inline constexpr Option tile_jobs_option = preference(
    in_group("tiles", {"--jobs", "N", "Tiles: number of parallel jobs.", default_jobs_words}));

/// Returns whether the path is an output for tiles: a file with a suffix of archives, or a folder.
bool is_tile_archive(const std::filesystem::path& place);

/// Returns the name endings of tile outputs: ".mbtiles, .pmtiles or /".
std::string tile_endings();

/// Parses --zoom and --jobs.
/// \throws UsageError  for invalid values.
TilePlan parse_tile_plan(const Arguments& arguments);

/// Rejects options of tiles.
/// \throws UsageError  if --zoom or --jobs is given; both apply to tiles only.
void expect_no_tile_options(const Arguments& arguments);

/// Statistics of an archive of vector tiles.
struct WrittenTiles {
    std::size_t segments = 0;
    TileCount count;
};

/// Writes vector tiles of the measured segments into an archive or a folder.
WrittenTiles write_vector_tiles(const StoreReader& store,
                                const SegmentFilter& filter,
                                const std::filesystem::path& file,
                                const TilePlan& plan,
                                const Console& console);

/// Writes vector tiles of the measured segments into an archive or a folder
/// (docs/reference/vector-tiles.md) and reports their number.
void export_tiles(const StoreReader& store,
                  const SegmentFilter& filter,
                  const std::filesystem::path& file,
                  const TilePlan& plan,
                  const Console& console);

} // namespace macadam
