#pragma once

#include "storage/rasters/base_map_file.hpp"
#include "support/files/files.hpp"
#include "support/files/placed_raster.hpp"
#include "support/program/shell.hpp"

#include <cmath>
#include <numbers>

namespace macadam::testing {

inline constexpr double radius_m = 6378137;
inline constexpr double rad_per_deg = std::numbers::pi / 180;

inline double mercator_x(double lon_deg) {
    return radius_m * lon_deg * rad_per_deg;
}

inline double mercator_y(double lat_deg) {
    return radius_m * std::asinh(std::tan(lat_deg * rad_per_deg));
}

inline std::string wkt_of(const std::filesystem::path& folder, const std::string& crs) {
    auto wkt = output_of(folder, "gdalsrsinfo -o wkt1 --single-line '" + crs + "'");
    std::erase(wkt, '\n');
    return wkt;
}

inline std::vector<int> pixel(const std::vector<std::uint8_t>& rgba, int width_px, int x, int y) {
    const auto* const at = rgba.data() + (std::size_t(y) * width_px + std::size_t(x)) * 4;
    return {at[0], at[1], at[2], at[3]};
}

inline std::vector<std::uint8_t> whole(const BaseMap& map, const PicturePlane& plane) {
    return map.laid_on(plane)({0, 0, plane.width_px, plane.height_px});
}

/// A map whose colours say where they are, around 16 degrees east and 48 north.
inline std::filesystem::path degrees(const std::filesystem::path& folder) {
    return write_raster(
        folder / "degrees.tif", {"EPSG:4326", 15.5, 48.5, 0.005, 240, 200}, place_as_colour);
}

inline PicturePlane around_krems(int width_px, int height_px) {
    return {.wkt = "",
            .left = mercator_x(15.6),
            .top = mercator_y(48.4),
            .per_px = mercator_x(0.8) / width_px,
            .width_px = width_px,
            .height_px = height_px};
}

} // namespace macadam::testing
