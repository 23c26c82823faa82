// Where rasters of other people's lie as base maps, checked by GDAL's own programs; and their
// parts.

#include "base_map_places.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::SizeIs;

struct Projected {
    std::string plane;
    PicturePlane picture;
};

TEST(BaseMapFile, LiesWhereItsCoordinatesSayInAnyProjection) {
    const auto folder = test_folder();
    const std::vector<PlacedRaster> rasters{{"EPSG:4326", 15.5, 48.5, 0.005, 240, 200},
                                            {"EPSG:3857", 1'730'000, 6'180'000, 600, 200, 210},
                                            {"EPSG:32633", 520'000, 5'370'000, 400, 230, 240},
                                            {"EPSG:31287", 540'000, 500'000, 450, 200, 200}};
    const std::vector<Projected> planes{{"EPSG:3857", around_krems(400, 300)},
                                        {"EPSG:32633", {"", 530'000, 5'360'000, 150, 500, 400}},
                                        {"EPSG:3035", {"", 4'735'000, 2'830'000, 180, 400, 400}},
                                        {"EPSG:4326", {"", 15.6, 48.4, 0.0015, 500, 400}}};
    for (const auto& raster : rasters) {
        const auto map = open_base_map(write_raster(folder / "map.tif", raster, place_as_colour));
        for (const auto& [crs, picture] : planes) {
            auto plane = picture;
            plane.wkt = crs == "EPSG:3857" ? "" : wkt_of(folder, crs);
            const auto rgba = whole(map, plane);
            std::vector<Coordinates> places;
            for (int y = 5; y < plane.height_px; y += 43) {
                for (int x = 3; x < plane.width_px; x += 37) {
                    places.push_back({plane.left + (x + 0.5) * plane.per_px,
                                      plane.top - (y + 0.5) * plane.per_px});
                }
            }
            const auto on_raster = transformed(folder, places, crs, raster.crs);
            std::size_t i = 0;
            int inside = 0;
            for (int y = 5; y < plane.height_px; y += 43) {
                for (int x = 3; x < plane.width_px; x += 37, ++i) {
                    const double column = (on_raster[i].x - raster.left) / raster.per_px;
                    const double row = (raster.top - on_raster[i].y) / raster.per_px;
                    if (column < 1 || row < 1 || column > raster.width_px - 1 ||
                        row > raster.height_px - 1) {
                        continue;
                    }
                    ++inside;
                    const auto found = pixel(rgba, plane.width_px, x, y);
                    // Half a level for the rounding to bytes, and a twentieth of a pixel.
                    EXPECT_NEAR(found[0], column - 0.5, 0.56) << raster.crs << " on " << crs;
                    EXPECT_NEAR(found[1], row - 0.5, 0.56) << raster.crs << " on " << crs;
                    EXPECT_EQ(found[3], 255);
                }
            }
            EXPECT_GT(inside, 50) << raster.crs << " on " << crs;
        }
    }
}

TEST(BaseMapFile, IsItselfPixelByPixelOnItsOwnPlane) {
    const auto folder = test_folder();
    const auto map = open_base_map(write_raster(
        folder / "map.tif", {"EPSG:3857", 1'700'000, 6'100'000, 10, 300, 200}, [](int x, int y) {
            return std::vector<std::uint8_t>{
                std::uint8_t(x * 37), std::uint8_t(y * 91), std::uint8_t(x ^ y)};
        }));
    const auto rgba = whole(map, {"", 1'700'000 - 50, 6'100'000 + 70, 10, 310, 214});
    for (int y = 0; y < 214; ++y) {
        for (int x = 0; x < 310; ++x) {
            const int column = x - 5;
            const int row = y - 7;
            const bool inside = column >= 0 && column < 300 && row >= 0 && row < 200;
            ASSERT_EQ(pixel(rgba, 310, x, y),
                      inside ? (std::vector<int>{
                                   column * 37 & 255, row * 91 & 255, (column ^ row) & 255, 255})
                             : (std::vector<int>{0, 0, 0, 0}))
                << x << ", " << y;
        }
    }
}

TEST(BaseMapFile, GoesOnOverTheAntimeridian) {
    const auto folder = test_folder();
    // Red says the longitude: a level is a degree and a half.
    const auto stripes = [](double west_deg) {
        return [=](int x, int) {
            const double lon_deg = west_deg + 1.5 * (x + 0.5);
            const double on_globe_deg = lon_deg > 180 ? lon_deg - 360 : lon_deg;
            return std::vector<std::uint8_t>{std::uint8_t((on_globe_deg + 180) / 1.5), 0, 0};
        };
    };
    const double per_px = mercator_x(40) / 400;
    const PicturePlane fiji{"", mercator_x(160), mercator_y(10), per_px, 400, 300};
    for (const double west_deg : {-180.0, 0.0}) {
        const auto map = open_base_map(write_raster(
            folder / "map.tif", {"EPSG:4326", west_deg, 90, 1.5, 240, 120}, stripes(west_deg)));
        const auto rgba = whole(map, fiji);
        for (const auto& [lon_deg, red] : std::vector<std::pair<double, int>>{
                 {165.75, 230}, {177.75, 238}, {182.25, 1}, {195.75, 10}}) {
            const int x = int((lon_deg - 160) * 10);
            EXPECT_EQ(pixel(rgba, 400, x, 150), (std::vector<int>{red, 0, 0, 255}))
                << lon_deg << ", west " << west_deg;
        }
        EXPECT_EQ(pixel(rgba, 400, 199, 150)[3], 255);
        EXPECT_EQ(pixel(rgba, 400, 200, 150)[3], 255);
    }
}

TEST(BaseMapFile, MeetsAPlaneThatLiesOverTheAntimeridianItself) {
    const auto folder = test_folder();
    const auto world = open_base_map(
        write_raster(folder / "map.tif", {"EPSG:4326", -180, 90, 1.5, 240, 120}, place_as_colour));
    const std::string fiji = "EPSG:3460"; // transverse Mercator around 178.75 degrees
    const PicturePlane plane{wkt_of(folder, fiji), 1'900'000, 4'300'000, 2000, 400, 300};
    const auto rgba = whole(world, plane);
    std::vector<Coordinates> places;
    for (int x = 0; x < 400; x += 10) {
        places.push_back({plane.left + (x + 0.5) * plane.per_px, plane.top - 150.5 * plane.per_px});
    }
    const auto degrees = transformed(folder, places, fiji, "EPSG:4326");
    int to_the_east = 0;
    for (int x = 0; x < 400; x += 10) {
        const double column = (degrees[std::size_t(x) / 10].x + 180) / 1.5;
        if (column > 1 && column < 239) { // the first and the last are not means of each other
            to_the_east += column < 120 ? 1 : 0;
            EXPECT_NEAR(pixel(rgba, 400, x, 150)[0], column - 0.5, 0.56) << x;
        }
        EXPECT_EQ(pixel(rgba, 400, x, 150)[3], 255) << x;
    }
    EXPECT_GT(to_the_east, 5);
}

TEST(BaseMapFile, ReachesThePoleAndTheHorizonAndNoFarther) {
    const auto folder = test_folder();
    const auto world = open_base_map(
        write_raster(folder / "map.tif", {"EPSG:4326", -180, 90, 1.5, 240, 120}, place_as_colour));
    const auto arctic =
        whole(world, {wkt_of(folder, "EPSG:3413"), -2'000'000, 2'000'000, 10'000, 400, 400});
    for (std::size_t at = 3; at < arctic.size(); at += 4) {
        ASSERT_EQ(arctic[at], 255) << at / 4;
    }
    // Longitude 135 east of the pole lies to the right of EPSG:3413's up (its meridian is -45).
    EXPECT_NEAR(pixel(arctic, 400, 350, 199)[0], (45 + 180) / 1.5 - 0.5, 1);

    const std::string globe = "+proj=ortho +lat_0=30 +lon_0=20 +a=6371000 +b=6371000";
    const auto seen = whole(world, {wkt_of(folder, globe), -7e6, 7e6, 35'000, 400, 400});
    for (const auto& [x, y] : std::vector<std::pair<int, int>>{{2, 2}, {397, 2}, {200, 2}}) {
        EXPECT_EQ(pixel(seen, 400, x, y)[3], 0) << x << ", " << y;
    }
    EXPECT_EQ(pixel(seen, 400, 200, 200), (std::vector<int>{133, 40, 7, 255})); // 20 east, 30 north
    EXPECT_EQ(pixel(seen, 400, 200, 25)[3], 255); // 175 px from the middle, the horizon is at 182
}

// ------------------------------------------------------------------------- parts and the whole

void expect_parts_are_the_whole(const BaseMap& map, const PicturePlane& plane) {
    const auto all = whole(map, plane);
    const auto paint = map.laid_on(plane);
    for (const int rows : {1, 7, 16, 100}) {
        std::vector<std::uint8_t> bands;
        for (int top = 0; top < plane.height_px; top += rows) {
            const auto band =
                paint({0, top, plane.width_px, std::min(rows, plane.height_px - top)});
            bands.insert(bands.end(), band.begin(), band.end());
        }
        EXPECT_TRUE(bands == all) << rows;
    }
    const auto part = paint({37, 53, 91, 61});
    for (int y = 0; y < 61; ++y) {
        for (int x = 0; x < 91; ++x) {
            ASSERT_EQ(pixel(part, 91, x, y), pixel(all, plane.width_px, 37 + x, 53 + y));
        }
    }
}

TEST(BaseMapFile, IsTheSameWhicheverPartIsAskedFor) {
    const auto folder = test_folder();
    const auto noise = [](int x, int y) {
        const auto seed = std::uint32_t(x * 7919 + y * 104729);
        return std::vector<std::uint8_t>{
            std::uint8_t(seed * 2654435761U >> 24), std::uint8_t(seed * 40503U >> 8), 0};
    };
    auto file =
        write_raster(folder / "map.tif", {"EPSG:31287", 500'000, 500'000, 100, 1500, 1200}, noise);
    const std::vector<PicturePlane> planes{
        around_krems(300, 260),                                 // on several pixels of the raster
        {"", mercator_x(15.7), mercator_y(48.3), 20, 240, 200}, // on a part of one
        {wkt_of(folder, "EPSG:3413"), 3'600'000, -1'000'000, 2500, 300, 300}};
    for (const auto& plane : planes) {
        expect_parts_are_the_whole(open_base_map(file), plane);
    }
    ASSERT_EQ(output_of(folder, "gdaladdo -q -r average " + file.string() + " 2 4 8"), "");
    for (const auto& plane : planes) {
        expect_parts_are_the_whole(open_base_map(file), plane);
    }
}

TEST(BaseMapFile, ThatClaimsATrillionPixelsTakesAsLongAsThePictureIsLarge) {
    const auto file = test_folder() / "claims.vrt";
    std::ofstream{file} << R"(<VRTDataset rasterXSize="2000000" rasterYSize="2000000">
<SRS>EPSG:3857</SRS><GeoTransform>1736000,0.0128,0,6176000,0,-0.0128</GeoTransform>
<VRTRasterBand dataType="Byte" band="1"><ColorInterp>Gray</ColorInterp></VRTRasterBand>
</VRTDataset>)";
    const auto map = open_base_map(file);
    const auto rgba = whole(map, {"", 1'736'000, 6'176'000, 512, 50, 50});
    ASSERT_THAT(rgba, SizeIs(4 * 50 * 50));
    EXPECT_THAT(pixel(rgba, 50, 25, 25), ElementsAre(0, 0, 0, 255)); // no source: the band is 0
}

TEST(BaseMapFile, IsTransparentWhereItDoesNotReach) {
    const auto folder = test_folder();
    const auto map = open_base_map(degrees(folder));
    const auto rgba = whole(map, {"", mercator_x(-70), mercator_y(-10), 50, 64, 64});
    EXPECT_THAT(rgba, Each(0));
}

} // namespace
} // namespace macadam::testing
