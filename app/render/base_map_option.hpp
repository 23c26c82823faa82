#pragma once

#include "app/cli/arguments.hpp"
#include "mapping/style/base_map.hpp"

#include <filesystem>
#include <memory>
#include <optional>

namespace macadam {

/// Requested base map and its opacity.
struct BaseMapChoice {
    std::filesystem::path file;
    std::optional<double> opacity; ///< 0 to 1
};

/// Parses --base; `std::nullopt` without it.
///
/// \throws UsageError  for an opacity out of its range, or without a base map.
std::optional<BaseMapChoice> parse_base_map(const Arguments& arguments);

/// Base map that records whether any of it appeared in the picture.
struct WatchedBaseMap {
    std::shared_ptr<const BaseMap> map;
    std::shared_ptr<const bool> is_seen;
};

/// Opens a base map.
/// \throws InputError  if the file is no base map.
WatchedBaseMap opened_base_map(const std::filesystem::path& file);

/// Combines the attribution of the roads with that of the base map, if it states one.
std::string attribution_with(const std::string& of_roads, const BaseMap& base);

inline constexpr Option base_option = in_group(
    "appearance",
    {"--base",
     "FILE",
     "Raster base map under the roads: GeoTIFF, MBTiles with pictures, or another format that "
     "GDAL reads."});
inline constexpr Option base_opacity_option =
    in_group("appearance", {"--base-opacity", "SHARE", "Opacity of the base map, 0 to 1.", "0.5"});

} // namespace macadam
