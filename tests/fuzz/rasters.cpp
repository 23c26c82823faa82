#include "fuzz/input_file.hpp"
#include "fuzz/rules.hpp"
#include "fuzz/targets.hpp"

#include "storage/base_map_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

namespace macadam::fuzz {
namespace {

std::filesystem::path raster_of(std::string_view input) {
    constexpr std::array<std::string_view, 3> names{"a.png", "a.pgw", "a.prj"};
    if (input.starts_with("=== ")) {
        return input_folder(names, input) / names[0];
    }
    return input_file(input.starts_with("SQLite") ? "a.mbtiles" : "a.tif", input);
}

} // namespace

Answer base_map(std::string_view input) {
    constexpr int side_px = 64;
    static const PicturePlane around_krems{.wkt = "",
                                           .left = 1'736'000, // m, of spherical Mercator
                                           .top = 6'176'000,
                                           .per_px = 400,
                                           .width_px = side_px,
                                           .height_px = side_px};
    const auto file = raster_of(input);
    return may_refuse([&] {
        const auto map = open_base_map(file);
        const auto paint = map.laid_on(around_krems);
        const auto whole = paint({0, 0, side_px, side_px});
        expect(whole.size() == std::size_t{4} * side_px * side_px, "every pixel has its colour");
        const auto corner = paint({side_px - 1, side_px - 1, 1, 1});
        expect(corner.size() == 4 && std::equal(corner.begin(), corner.end(), whole.end() - 4),
               "a pixel is the same in every part");
    });
}

} // namespace macadam::fuzz
