#include "storage/rasters/georeferenced_picture.hpp"

#include "support/files/files.hpp"
#include "support/program/shell.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// UTM zone 33 N, as PROJ writes it.
constexpr const char* utm33 =
    R"(PROJCS["WGS 84 / UTM zone 33N",GEOGCS["WGS 84",DATUM["WGS_1984",)"
    R"(SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],)"
    R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]],)"
    R"(PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
    R"(PARAMETER["central_meridian",15],PARAMETER["scale_factor",0.9996],)"
    R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],)"
    R"(AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","32633"]])";

/// 600 x 400 pixels, each of another colour than its neighbours.
std::vector<std::uint8_t> colours() {
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < 400; ++y) {
        for (int x = 0; x < 600; ++x) {
            rgb.insert(rgb.end(), {std::uint8_t(x), std::uint8_t(y), std::uint8_t(x / 256)});
        }
    }
    return rgb;
}

/// Row by row, and then the rest at once.
GiveRows rows_of(const std::vector<std::uint8_t>& rgb, std::size_t width_px) {
    return [&rgb, row = 3 * width_px](const auto& take) {
        const std::span all{rgb};
        for (std::size_t i = 0; i < 5; ++i) {
            take(all.subspan(i * row, row));
        }
        take(all.subspan(5 * row));
    };
}

PictureFrame picture() {
    return {.width_px = 600,
            .height_px = 400,
            .left = 500'000,
            .top = 5'600'000,
            .per_px = 2.5,
            .wkt = utm33,
            .copyright = "© \"Mappers\" & <others>"};
}

json info_by_gdal(const fs::path& folder, const fs::path& file) {
    const auto text = output_of(folder, "gdalinfo -json " + file.string());
    return json::parse(text, nullptr, false);
}

TEST(GeoTiff, LiesWhereItShould) {
    const auto folder = test_folder();
    const auto rgb = colours();
    write_geotiff(picture(), rows_of(rgb, 600), folder / "map.tif");
    const auto info = info_by_gdal(folder, folder / "map.tif");
    EXPECT_EQ(info["size"], json::parse("[600, 400]"));
    EXPECT_EQ(info["geoTransform"], json::parse("[500000.0, 2.5, 0.0, 5600000.0, 0.0, -2.5]"));
    EXPECT_THAT(info["coordinateSystem"]["wkt"].get<std::string>(),
                HasSubstr("ID[\"EPSG\",32633]"));
    EXPECT_EQ(info["metadata"][""]["TIFFTAG_COPYRIGHT"], "© \"Mappers\" & <others>");
    EXPECT_EQ(info["metadata"]["IMAGE_STRUCTURE"]["LAYOUT"], "COG");
}

TEST(GeoTiff, HoldsEveryPixel) {
    const auto folder = test_folder();
    const auto rgb = colours();
    write_geotiff(picture(), rows_of(rgb, 600), folder / "map.tif");
    ASSERT_EQ(output_of(folder,
                        "gdal_translate -q -of PNM " + (folder / "map.tif").string() + " " +
                            (folder / "map.ppm").string()),
              "");
    const auto ppm = content_of(folder / "map.ppm");
    EXPECT_TRUE(ppm.ends_with(std::string{rgb.begin(), rgb.end()}));
}

TEST(GeoTiff, PassesTheValidatorOfCloudOptimizedFiles) {
    const auto folder = test_folder();
    const std::vector<std::uint8_t> rgb(3 * 1500 * 1200, 200); // large enough for smaller copies
    auto large = picture();
    large.width_px = 1500;
    large.height_px = 1200;
    write_geotiff(large, rows_of(rgb, 1500), folder / "map.tif");
    EXPECT_THAT(
        output_of(folder,
                  "/usr/bin/python3 -m osgeo_utils.samples.validate_cloud_optimized_geotiff " +
                      (folder / "map.tif").string()),
        HasSubstr("is a valid cloud optimized GeoTIFF"));
}

TEST(GeoTiff, IsTheSameByteForByteEachTime) {
    const auto folder = test_folder();
    const auto rgb = colours();
    write_geotiff(picture(), rows_of(rgb, 600), folder / "a.tif");
    write_geotiff(picture(), rows_of(rgb, 600), folder / "b.tif");
    EXPECT_TRUE(content_of(folder / "a.tif") == content_of(folder / "b.tif"));
}

TEST(GeoTiff, LeavesNothingWhereItCannotBeWritten) {
    const auto folder = test_folder();
    const auto rgb = colours();
    auto lost = picture();
    lost.wkt = "nonsense";
    EXPECT_THAT(refusal_of([&] { write_geotiff(lost, rows_of(rgb, 600), folder / "map.tif"); }),
                HasSubstr("map.tif: cannot be written"));
    EXPECT_TRUE(fs::is_empty(folder));
    EXPECT_THAT(refusal_of([&] {
                    write_geotiff(picture(), rows_of(rgb, 600), folder / "none" / "map.tif");
                }),
                HasSubstr("map.tif: cannot be written: No such file or directory"));
}

TEST(GeoTiff, LeavesNothingWhereItIsStopped) {
    const auto folder = test_folder();
    const auto rgb = colours();
    const auto stopped = [&](const auto& take) {
        take(std::span{rgb}.first(3 * 600));
        throw InputError{"stopped before the picture was complete"};
    };
    EXPECT_THAT(refusal_of([&] { write_geotiff(picture(), stopped, folder / "map.tif"); }),
                HasSubstr("stopped before the picture was complete"));
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(WorldFile, SaysWhereThePictureLies) {
    const auto folder = test_folder();
    fs::create_directory(folder / "out");
    // The smallest PNG there is will do: one grey pixel.
    const std::string png{
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\x3a\x7e\x9b\x55"
        "\0\0\0\nIDAT\x08\xd7\x63\x68\0\0\0\x82\0\x81\xdd\x43\x6a\xf4\0\0\0\0IEND\xae\x42\x60\x82",
        67};
    write_png_with_world_file(
        [&](const auto& take) {
            take(png.substr(0, 40));
            take(png.substr(40));
        },
        picture(),
        folder / "out" / "map.png");
    EXPECT_EQ(content_of(folder / "out" / "map.pgw"), "2.5\n0\n0\n-2.5\n500001.25\n5599998.75\n");
    const auto info = info_by_gdal(folder, folder / "out" / "map.png");
    EXPECT_EQ(info["geoTransform"], json::parse("[500000.0, 2.5, 0.0, 5600000.0, 0.0, -2.5]"));
    EXPECT_THAT(info["coordinateSystem"]["wkt"].get<std::string>(),
                HasSubstr("ID[\"EPSG\",32633]"));
    EXPECT_EQ(content_of(folder / "out" / "map.png"), png);
}

TEST(WorldFile, LeavesNothingWhereOneOfTheSetCannotBeWritten) {
    const auto folder = test_folder();
    fs::create_directories(folder / "map.pgw" / "in the way");
    EXPECT_THAT(refusal_of([&] {
                    write_png_with_world_file(
                        [](const auto& take) { take("png"); }, picture(), folder / "map.png");
                }),
                HasSubstr("map.pgw: cannot be written: Is a directory"));
    EXPECT_FALSE(fs::exists(folder / "map.png"));
    EXPECT_FALSE(fs::exists(folder / "map.png.aux.xml"));
}

} // namespace
} // namespace macadam::testing
