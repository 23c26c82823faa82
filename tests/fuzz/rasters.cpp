#include "input_file.hpp"
#include "rules.hpp"
#include "targets.hpp"

#include "storage/rasters/base_map_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

namespace macadam::fuzz {
namespace {

std::filesystem::path raster_of(std::string_view input) {
    constexpr std::array<std::string_view, 4> names{"a.png", "a.pgw", "a.prj", "b.tif"};
    if (input.starts_with("=== ")) {
        return input_folder(names, input) / names[0];
    }
    return input_file(input.starts_with("SQLite") ? "a.mbtiles" : "a.tif", input);
}

/// Krems in spherical Mercator, and half of the globe as from far above Krems: there the seeds are
/// made much smaller, and the corners are beyond the horizon.
const std::vector<PicturePlane>& planes() {
    static const std::vector<PicturePlane> all{
        {.wkt = "",
         .left = 1'736'000, // m
         .top = 6'176'000,
         .per_px = 400,
         .width_px = 64,
         .height_px = 64},
        {.wkt = R"(PROJCS["from above",GEOGCS["WGS 84",DATUM["WGS_1984",)"
                R"(SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],)"
                R"(UNIT["degree",0.0174532925199433]],PROJECTION["Orthographic"],)"
                R"(PARAMETER["latitude_of_origin",48.4],PARAMETER["central_meridian",15.6],)"
                R"(PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]])",
         .left = -6'400'000,
         .top = 6'400'000,
         .per_px = 400'000,
         .width_px = 32,
         .height_px = 32}};
    return all;
}

void expect_sound(const PaintPart& paint, const PicturePlane& plane) {
    const int right = plane.width_px - 1, bottom = plane.height_px - 1;
    const auto whole = paint({0, 0, plane.width_px, plane.height_px});
    expect(whole.size() == std::size_t(plane.width_px) * std::size_t(plane.height_px) * 4,
           "every pixel has its colour");
    const auto corner = paint({right, bottom, 1, 1});
    expect(corner.size() == 4 && std::equal(corner.begin(), corner.end(), whole.end() - 4),
           "a pixel is the same in every part");
}

} // namespace

Answer base_map(std::string_view input) {
    const auto file = raster_of(input);
    expect(may_refuse([&] { open_base_map(file.parent_path()); }) == Answer::refused,
           "a folder is no raster");
    return may_refuse([&] {
        const auto map = open_base_map(file);
        for (const auto& plane : planes()) {
            expect_sound(map.laid_on(plane), plane);
        }
    });
}

} // namespace macadam::fuzz
