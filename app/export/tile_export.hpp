#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/export/tile_pyramid.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>
#include <string>

namespace macadam {

inline constexpr Option zoom_option{
    "--zoom",
    "A-B",
    "Tiles: zoom levels, from 0 to 18 (single segments appear from zoom 14).",
    "6-16"};
inline constexpr Option tile_jobs_option{"--jobs", "N", "Tiles: number of parallel jobs.", "1"};

/// Whether tiles are written there: into a file of such a suffix, or a folder.
bool is_tile_archive(const std::filesystem::path& place);

/// How -o says that tiles are wanted: ".mbtiles, .pmtiles or /".
std::string tile_endings();

/// Of --zoom and --jobs. \throws UsageError  for values that do not fit.
TilePlan parse_tile_plan(const Arguments& arguments);

/// \throws UsageError  if one of --zoom and --jobs is there, which go with tiles alone.
void expect_no_tile_options(const Arguments& arguments);

/// Writes vector tiles of the store's measured segments into an archive or a folder
/// (docs/reference/vector-tiles.md) and says how many.
void export_tiles(const RoadStore& store,
                  const SegmentFilter& filter,
                  const std::filesystem::path& file,
                  const TilePlan& plan,
                  const Console& console);

} // namespace macadam
