#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "mapping/style/base_map.hpp"

#include <filesystem>
#include <memory>
#include <optional>

namespace macadam {

/// A base map that was asked for, and how much of it is to be seen.
struct BaseMapChoice {
    std::filesystem::path file;
    std::optional<double> opacity; ///< 0 to 1
};

/// Nothing without --base.
///
/// \throws UsageError  for an opacity out of its range, or one of nothing.
std::optional<BaseMapChoice> parse_base_map(const Arguments& arguments);

/// A base map that knows whether any of it has come to be on the picture.
struct WatchedBaseMap {
    std::shared_ptr<const BaseMap> map;
    std::shared_ptr<const bool> is_seen;
};

/// \throws InputError  if the file is no base map.
WatchedBaseMap opened_base_map(const std::filesystem::path& file);

/// Whose data a map shows: that of the roads, and that of the base map where it says whose it is.
std::string attribution_with(const std::string& of_roads, const BaseMap& base);

inline constexpr Option base_option{
    "--base",
    "FILE",
    "Raster base map under the roads: GeoTIFF, MBTiles with pictures, or another format that "
    "GDAL reads."};
inline constexpr Option base_opacity_option{
    "--base-opacity", "SHARE", "Opacity of the base map, 0 to 1.", "0.5"};

} // namespace macadam
