#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/export/raster_tiles.hpp"
#include "estimator/common/geo.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

inline constexpr Option tiles_option = one_of(
    "vector|picture",
    in_group("tiles", {"--tiles", "WHAT", "Kind of tiles: vector or picture (PNG).", "vector"}));
inline constexpr Option tile_size_option = rare(one_of(
    "256|512",
    in_group("tiles", {"--tile-size", "PX", "Picture tiles: 256 or 512 pixels per side.", "256"})));
inline constexpr Option tile_theme_option = preference(rare(one_of(
    "light|dark|print",
    in_group("tiles", {"--theme", "NAME", "Picture tiles: light, dark or print.", "light"}))));
inline constexpr Option tile_left_hand_option =
    preference(rare(in_group("tiles", {"--left-hand", "", "Picture tiles: traffic keeps left."})));
inline constexpr Option tile_no_labels_option =
    rare(in_group("tiles", {"--no-labels", "", "Picture tiles: omit road names."}));

/// Parses the plan of picture tiles if --tiles asks for them; the box is set later.
///
/// \param tiles        values of --zoom and --jobs
/// \throws UsageError  for invalid values, for options of picture tiles without them, and for
///                     filters that picture tiles do not support: they show all roads of a box.
std::optional<PicturePlan> parse_picture_plan(const Arguments& arguments,
                                              const TilePlan& tiles,
                                              const SegmentFilter& filter,
                                              const Console& console);

/// Rejects options of picture tiles.
/// \throws UsageError  if one is given.
void expect_no_picture_options(const Arguments& arguments);

/// Draws picture tiles of a database into an archive (docs/reference/pictures.md) and reports their
/// number.
/// \param box  `std::nullopt`: the driven extent
void export_picture_tiles(const std::filesystem::path& store,
                          const std::optional<GeoBox>& box,
                          const std::filesystem::path& file,
                          PicturePlan plan,
                          const Console& console);

} // namespace macadam
