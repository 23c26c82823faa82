// What colours a raster has as a base map, at which resolution, and whose it is.

#include "base_map_places.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

TEST(BaseMapFile, IsTheMeanOfItsPixelsWhereItIsMadeSmaller) {
    const auto folder = test_folder();
    const auto file = write_raster(
        folder / "map.tif", {"EPSG:3857", 1'700'000, 6'100'000, 10, 2000, 2000}, [](int x, int y) {
            const std::uint8_t grey = (x + y) % 2 == 0 ? 255 : 55;
            return std::vector<std::uint8_t>{grey, grey, grey};
        });
    for (const double times : {3.3, 8.0, 21.0}) {
        const int side_px = int(2000 / times) - 1;
        const auto rgba =
            whole(open_base_map(file), {"", 1'700'003, 6'099'996, 10 * times, side_px, side_px});
        ASSERT_EQ(rgba.size(), std::size_t(side_px) * std::size_t(side_px) * 4);
        for (std::size_t at = 0; at < rgba.size(); at += 4) {
            // The mean is 155; a tent of few pixels does not weigh black and white quite alike.
            ASSERT_NEAR(rgba[at], 155, 3) << times;
        }
    }
}

TEST(BaseMapFile, TakesTheSmallerCopyThatFitsThePicture) {
    const auto folder = test_folder();
    const auto of_one_colour = [](std::uint8_t red) {
        return [=](int, int) { return std::vector<std::uint8_t>{red, 0, 0}; };
    };
    const auto file = write_raster(
        folder / "map.tif", {"EPSG:3857", 1'700'000, 6'100'000, 10, 800, 800}, of_one_colour(200));
    // GDAL takes a file of this name for a copy of half the size, whatever its colours.
    const auto half = write_raster(
        folder / "half.tif", {"EPSG:3857", 1'700'000, 6'100'000, 20, 400, 400}, of_one_colour(100));
    fs::rename(half, folder / "map.tif.ovr");
    const auto map = open_base_map(file);
    const auto red_at = [&](double per_px) {
        return pixel(whole(map, {"", 1'701'000, 6'099'000, per_px, 64, 64}), 64, 30, 30)[0];
    };
    EXPECT_EQ(red_at(5), 200);
    EXPECT_EQ(red_at(10), 200);
    EXPECT_EQ(red_at(18), 200);
    EXPECT_EQ(red_at(20), 100);
    EXPECT_EQ(red_at(50), 100);
}

TEST(BaseMapFile, ReadsALargeRasterWithoutSmallerCopies) {
    const auto folder = test_folder();
    const auto file = folder / "large.tif";
    ASSERT_EQ(output_of(folder,
                        "gdal_create -q -of GTiff -outsize 8000 8000 -bands 3 -burn 90 -burn 120 "
                        "-burn 30 -a_srs EPSG:3857 -a_ullr 0 80000 80000 0 -co TILED=YES -co "
                        "COMPRESS=DEFLATE " +
                            file.string()),
              "");
    const auto rgba = whole(open_base_map(file), {"", 0, 80'000, 200, 400, 400});
    for (int i = 0; i < 400; ++i) {
        ASSERT_EQ(pixel(rgba, 400, i, i), (std::vector<int>{90, 120, 30, 255}));
    }
}

TEST(BaseMapFile, ReadsAVeryWideRasterPieceByPiece) {
    // 40 x 2 colours, each 512 pixels wide and high: a mean over 512 is the colour itself.
    const auto folder = test_folder();
    const auto small =
        write_raster(folder / "small.tif", {"EPSG:3857", 0, 1024, 512, 40, 2}, [](int x, int y) {
            return std::vector<std::uint8_t>{std::uint8_t(5 * x), std::uint8_t(90 * y), 7};
        });
    const auto wide = folder / "wide.vrt";
    ASSERT_EQ(output_of(folder,
                        "gdal_translate -q -of VRT -r nearest -outsize 20480 1024 " +
                            small.string() + " " + wide.string()),
              "");
    const auto rgba = whole(open_base_map(wide), {"", 0, 1024, 512, 40, 2});
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 40; ++x) {
            ASSERT_EQ(pixel(rgba, 40, x, y), (std::vector<int>{5 * x, 90 * y, 7, 255})) << x << y;
        }
    }
}

// --------------------------------------------------------------------------------- its colours

/// The first pixel of a raster of one pixel's kind.
std::vector<int> colour_of(const fs::path& file) {
    return pixel(whole(open_base_map(file), {"", 0, 100, 10, 4, 4}), 4, 1, 1);
}

fs::path grey(const fs::path& folder, const std::string& more, int value = 80) {
    return write_raster(
        folder / "grey.tif", {"EPSG:3857", 0, 100, 10, 10, 10, "-b 1 " + more}, [=](int, int) {
            return std::vector<std::uint8_t>{std::uint8_t(value), 0, 0};
        });
}

TEST(BaseMapFile, HasTheColoursOfItsKind) {
    const auto folder = test_folder();
    EXPECT_THAT(colour_of(grey(folder, "")), ElementsAre(80, 80, 80, 255));
    EXPECT_THAT(colour_of(grey(folder, "-co NBITS=1", 1)), ElementsAre(255, 255, 255, 255));
    EXPECT_THAT(colour_of(grey(folder, "-a_nodata 80")), ElementsAre(0, 0, 0, 0));
    EXPECT_THAT(colour_of(grey(folder, "-a_nodata 81")), ElementsAre(80, 80, 80, 255));

    const auto file = folder / "made.tif";
    const auto made = [&](const std::string& options) {
        EXPECT_EQ(output_of(folder,
                            "gdal_create -q -of GTiff -outsize 10 10 -a_srs EPSG:3857 -a_ullr 0 "
                            "100 100 0 " +
                                options + " " + file.string()),
                  "");
        return file;
    };
    EXPECT_THAT(colour_of(made("-bands 3 -burn 10 -burn 20 -burn 30")),
                ElementsAre(10, 20, 30, 255));
    EXPECT_THAT(colour_of(made("-bands 4 -burn 10 -burn 20 -burn 30 -burn 128 -co ALPHA=YES")),
                ElementsAre(10, 20, 30, 128));
    EXPECT_THAT(colour_of(made("-bands 2 -burn 10 -burn 64 -co ALPHA=YES")),
                ElementsAre(10, 10, 10, 64));
    EXPECT_THAT(colour_of(made("-bands 4 -burn 10 -burn 20 -burn 30 -burn 90 -co ALPHA=NO")),
                ElementsAre(10, 20, 30, 255)); // near infrared
    EXPECT_THAT(colour_of(made("-bands 3 -burn 0 -burn 0 -burn 0 -a_nodata 0")),
                ElementsAre(0, 0, 0, 0));
    EXPECT_THAT(colour_of(made("-bands 3 -burn 0 -burn 20 -burn 0 -a_nodata 0")),
                ElementsAre(0, 20, 0, 255)); // green, not "no data"
}

TEST(BaseMapFile, HasTheColoursOfItsPalette) {
    const auto folder = test_folder();
    const auto plain = grey(folder, "", 1);
    const auto text =
        output_of(folder, "gdal_translate -q -of VRT " + plain.string() + " /vsistdout/");
    const std::string interpretation = "<ColorInterp>Red</ColorInterp>";
    auto vrt = text;
    ASSERT_NE(vrt.find(interpretation), std::string::npos) << vrt;
    vrt.replace(vrt.find(interpretation),
                interpretation.size(),
                "<ColorInterp>Palette</ColorInterp><ColorTable><Entry c1=\"1\" c2=\"2\" c3=\"3\" "
                "c4=\"255\"/><Entry c1=\"200\" c2=\"100\" c3=\"50\" c4=\"255\"/></ColorTable>");
    EXPECT_THAT(colour_of(written(folder, "map.vrt", vrt)), ElementsAre(200, 100, 50, 255));
}

TEST(BaseMapFile, LetsTransparentPixelsHaveNoShareInTheColoursBesideThem) {
    const auto folder = test_folder();
    const auto file = write_raster(
        folder / "map.tif", {"EPSG:3857", 0, 1000, 10, 100, 100, "-a_nodata 0"}, [](int x, int) {
            return x % 2 == 0 ? std::vector<std::uint8_t>{0, 0, 0}
                              : std::vector<std::uint8_t>{200, 100, 50};
        });
    const auto rgba = whole(open_base_map(file), {"", 0, 1000, 40, 25, 25});
    const auto middle = pixel(rgba, 25, 12, 12);
    EXPECT_THAT((std::vector<int>{middle[0], middle[1], middle[2]}), ElementsAre(200, 100, 50));
    EXPECT_NEAR(middle[3], 128, 8); // one of two
}

// ------------------------------------------------------------------------------------- MBTiles

fs::path mbtiles(const fs::path& folder) {
    const auto tif = degrees(folder);
    auto file = folder / "map.mbtiles";
    EXPECT_EQ(
        output_of(folder, "gdal_translate -q -of MBTILES " + tif.string() + " " + file.string()),
        "");
    EXPECT_EQ(output_of(folder, "gdaladdo -q -r average " + file.string()), "");
    return file;
}

void set_metadata(const fs::path& file, const std::string& name, const std::string& value) {
    sqlite3* base = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &base), SQLITE_OK);
    const auto insert = fmt::format("INSERT INTO metadata VALUES ('{}', '{}')", name, value);
    EXPECT_EQ(sqlite3_exec(base, insert.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(base);
}

TEST(BaseMapFile, ReadsTilesOfPicturesAtTheZoomThatFits) {
    const auto folder = test_folder();
    const auto map = open_base_map(mbtiles(folder));
    for (const int side_px : {60, 600}) {
        const auto plane = around_krems(side_px, side_px / 2);
        const auto rgba = whole(map, plane);
        for (const double share : {0.3, 0.6}) {
            const int x = int(share * side_px);
            const int y = int(share * side_px / 2);
            const double lon_deg = 15.6 + 0.8 * (x + 0.5) / side_px;
            const double lat_deg =
                std::atan(std::sinh((plane.top - (y + 0.5) * plane.per_px) / radius_m)) /
                rad_per_deg;
            const auto found = pixel(rgba, side_px, x, y);
            // The tiles are a picture of the degrees themselves: a level each of two roundings.
            EXPECT_NEAR(found[0], (lon_deg - 15.5) / 0.005 - 0.5, 2);
            EXPECT_NEAR(found[1], (48.5 - lat_deg) / 0.005 - 0.5, 2);
        }
    }
}

TEST(BaseMapFile, SaysWhoseItIs) {
    const auto folder = test_folder();
    EXPECT_EQ(open_base_map(degrees(folder)).attribution, "");
    EXPECT_EQ(open_base_map(
                  write_raster(
                      folder / "owned.tif",
                      {"EPSG:4326", 15, 48, 0.01, 10, 10, "-mo 'TIFFTAG_COPYRIGHT=© Land <Wien>'"},
                      place_as_colour))
                  .attribution,
              "© Land <Wien>"); // plain text, unlike that of MBTiles
    EXPECT_EQ(
        open_base_map(
            write_raster(folder / "older.tif",
                         {"EPSG:4326", 15, 48, 0.01, 10, 10, "-mo 'TIFFTAG_COPYRIGHT=\xa9 IGN'"},
                         place_as_colour))
            .attribution,
        "© IGN"); // Latin 1
    const auto tiles = mbtiles(folder);
    set_metadata(tiles,
                 "attribution",
                 "<a href=\"https://basemap.at\" target=\"_blank\">&copy; basemap.at</a> "
                 "&amp; friends");
    EXPECT_EQ(open_base_map(tiles).attribution, "© basemap.at & friends");
}

} // namespace
} // namespace macadam::testing
