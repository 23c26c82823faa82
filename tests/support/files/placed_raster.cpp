#include "placed_raster.hpp"

#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace macadam::testing {

std::filesystem::path write_raster(const std::filesystem::path& file,
                                   const PlacedRaster& raster,
                                   const ColourOf& colour) {
    const auto plain = file.string() + ".ppm";
    {
        std::ofstream out{plain, std::ios::binary};
        out << fmt::format("P6\n{} {}\n255\n", raster.width_px, raster.height_px);
        for (int y = 0; y < raster.height_px; ++y) {
            for (int x = 0; x < raster.width_px; ++x) {
                const auto rgb = colour(x, y);
                out.write(reinterpret_cast<const char*>(rgb.data()), 3);
            }
        }
    }
    const auto said = output_of(
        file.parent_path(),
        fmt::format("gdal_translate -q -a_srs '{}' -a_ullr {:.9f} {:.9f} {:.9f} {:.9f} {} {} {}",
                    raster.crs,
                    raster.left,
                    raster.top,
                    raster.left + raster.width_px * raster.per_px,
                    raster.top - raster.height_px * raster.per_px,
                    raster.more,
                    plain,
                    file.string()));
    EXPECT_EQ(said, "");
    std::filesystem::remove(plain);
    return file;
}

std::vector<std::uint8_t> place_as_colour(int x, int y) {
    return {std::uint8_t(x), std::uint8_t(y), 7};
}

std::vector<Coordinates> transformed(const std::filesystem::path& folder,
                                     const std::vector<Coordinates>& places,
                                     const std::string& from,
                                     const std::string& to) {
    {
        std::ofstream out{folder / "places.txt"};
        for (const auto& place : places) {
            out << fmt::format("{:.12f} {:.12f}\n", place.x, place.y);
        }
    }
    std::istringstream in{
        output_of(folder,
                  fmt::format("gdaltransform -s_srs '{}' -t_srs '{}' -output_xy < {}",
                              from,
                              to,
                              (folder / "places.txt").string()))};
    std::vector<Coordinates> found;
    for (Coordinates at{}; in >> at.x >> at.y;) {
        found.push_back(at);
    }
    EXPECT_EQ(found.size(), places.size());
    return found;
}

} // namespace macadam::testing
