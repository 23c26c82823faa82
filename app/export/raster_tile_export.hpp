#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/export/raster_tiles.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

inline constexpr Option tiles_option{
    "--tiles", "WHAT", "Kind of tiles: vector or picture (PNG).", "vector"};
inline constexpr Option tile_size_option{
    "--tile-size", "PX", "Picture tiles: 256 or 512 pixels per side.", "256"};
inline constexpr Option tile_theme_option{
    "--theme", "NAME", "Picture tiles: light, dark or print.", "light"};
inline constexpr Option tile_left_hand_option{
    "--left-hand", "", "Picture tiles: traffic keeps left."};
inline constexpr Option tile_no_labels_option{"--no-labels", "", "Picture tiles: omit road names."};

/// How picture tiles are to be drawn, if --tiles asks for them; the box is still to come.
///
/// \param tiles  of --zoom and --jobs
/// \throws UsageError  for values that do not fit, for options of picture tiles without them, and
///                     for a filter that picture tiles do not know: they show all roads of a box.
std::optional<PicturePlan>
parse_picture_plan(const Arguments& arguments, const TilePlan& tiles, const SegmentFilter& filter);

/// \throws UsageError  if an option of picture tiles is there.
void expect_no_picture_options(const Arguments& arguments);

/// Draws a store's picture tiles into an archive (docs/reference/pictures.md) and says how many.
/// \param box  nothing: all that was driven
void export_picture_tiles(const std::filesystem::path& store,
                          const std::optional<GeoBox>& box,
                          const std::filesystem::path& file,
                          PicturePlan plan,
                          const Console& console);

} // namespace macadam
