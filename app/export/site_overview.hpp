#pragma once

#include "app/cli/console.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/records/segment_filter.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Name of the picture in a site.
inline constexpr std::string_view overview_file = "overview.png";

/// Draws all roads of a selection as the picture that takes the place of the map in browsers that
/// cannot draw one.
///
/// \param file   the picture
/// \param title  above the roads
/// \returns      false, with a warning, if this machine cannot draw
bool write_overview(const StoreReader& store,
                    const SegmentFilter& filter,
                    const std::filesystem::path& file,
                    const std::string& title,
                    bool left_hand,
                    const Console& console);

/// Draws the map alone, as the page shows it before its own map is ready: first_light.png and
/// first_dark.png in spherical Mercator, up to the edges.
///
/// \param bounds  of the roads
/// \returns       bounds of the pictures; `std::nullopt` if this machine cannot draw
std::optional<GeoBox> write_first_pictures(const StoreReader& store,
                                           const SegmentFilter& filter,
                                           const std::filesystem::path& folder,
                                           const GeoBox& bounds,
                                           bool left_hand,
                                           const Console& console);

} // namespace macadam
