// `macadam render --base` as users run it.

#include "mapping/network/build_network.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/placed_raster.hpp"
#include "support/program/picture_program.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<int> ground{0xf4, 0xf4, 0xf2};

class BaseMapProgram : public PictureProgram {
protected:
    macadam::testing::Run done(const std::vector<std::string>& words) const {
        auto run = render(words);
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return run;
    }

    /// 120 x 120 pixels that say their place, around the middle of the roads.
    std::string around_the_roads(const std::string& name, const std::string& more = {}) const {
        const auto middle = halfway_along(measured_[0].segment.line);
        return write_raster(folder_ / name,
                            {"EPSG:4326",
                             middle.lon_deg - 60 * raster_deg,
                             middle.lat_deg + 60 * raster_deg,
                             raster_deg,
                             120,
                             120,
                             more},
                            place_as_colour)
            .string();
    }

    std::string box() const {
        const auto middle = halfway_along(measured_[0].segment.line);
        return fmt::format("--bbox={:.6f},{:.6f},{:.6f},{:.6f}",
                           middle.lon_deg - 50 * raster_deg,
                           middle.lat_deg - 50 * raster_deg,
                           middle.lon_deg + 50 * raster_deg,
                           middle.lat_deg + 50 * raster_deg);
    }

    std::vector<int> colour_at(const std::string& file, double lon_deg, double lat_deg) const {
        std::istringstream in{output_of(
            folder_,
            fmt::format(
                "gdallocationinfo -valonly -wgs84 {} {:.9f} {:.9f}", file, lon_deg, lat_deg))};
        std::vector<int> bands;
        for (int value = 0; in >> value;) {
            bands.push_back(value);
        }
        return bands;
    }

    static constexpr double raster_deg = 2e-4;
};

} // namespace

TEST_F(BaseMapProgram, ShowsTheBaseMapWhereItIsInTheWorld) {
    const auto base = around_the_roads("base.tif");
    const auto middle = halfway_along(measured_[0].segment.line);
    for (const auto* crs : {"EPSG:3857", "EPSG:2154", "EPSG:3035"}) {
        const auto file = out("map.tif");
        done({"-o",
              file,
              "--bare",
              "--size",
              "1200x900",
              "--crs",
              crs,
              "--base",
              base,
              "--base-opacity",
              "1",
              "--no-labels",
              box()});
        int shown = 0;
        for (int row = 15; row < 110; row += 13) {
            for (int column = 15; column < 110; column += 13) {
                const auto found = colour_at(file,
                                             middle.lon_deg + (column + 0.5 - 60) * raster_deg,
                                             middle.lat_deg - (row + 0.5 - 60) * raster_deg);
                ASSERT_EQ(found.size(), 3U);
                if (found[2] == 7) { // no road there
                    ++shown;
                    EXPECT_NEAR(found[0], column, 0.6) << crs;
                    EXPECT_NEAR(found[1], row, 0.6) << crs;
                }
            }
        }
        EXPECT_GT(shown, 40) << crs;
        EXPECT_NE(colour_at(file, middle.lon_deg, middle.lat_deg)[2], 7) << crs; // the road
    }
}

TEST_F(BaseMapProgram, GoesOnOverTheAntimeridian) {
    auto ways = road_art("A---B C---D", 5, {"AB", "CD"}).ways;
    ways[0].line = {{-17, 179.8}, {-17.01, 179.8}};
    ways[1].line = {{-17, -179.8}, {-17.01, -179.8}};
    store_ = (folder_ / "fiji.gpkg").string();
    RoadStore::create(store_, build_network(std::move(ways), 20), settings());
    const auto world =
        write_raster(folder_ / "world.tif", {"EPSG:4326", -180, 90, 1.5, 240, 120}, [](int x, int) {
            return std::vector<std::uint8_t>{std::uint8_t(x), std::uint8_t(255 - x), 7};
        }).string();
    const auto file = out("map.tif");
    const auto run = done({"-o",
                           file,
                           "--bare",
                           "--bbox",
                           "177.3,-17.1,-177.3,-16.9",
                           "--size",
                           "2000x2000",
                           "--base",
                           world,
                           "--base-opacity",
                           "1"});
    EXPECT_THAT(run.err, Not(HasSubstr("does not overlap")));
    for (const auto& [lon_deg, red] : std::vector<std::pair<double, int>>{
             {177.75, 238}, {179.3, 239}, {180.7, 0}, {182.25, 1}}) {
        EXPECT_EQ(output_of(folder_,
                            fmt::format("gdallocationinfo -valonly -geoloc {} {:.3f} {:.3f}",
                                        file,
                                        6378137 * lon_deg * M_PI / 180,
                                        6378137 * std::asinh(std::tan(-16.95 * M_PI / 180)))),
                  fmt::format("{}\n{}\n7\n", red, 255 - red))
            << lon_deg;
    }
}

TEST_F(BaseMapProgram, ShowsHalfOfTheBaseMapUnlessToldOtherwise) {
    const auto base = around_the_roads("base.tif");
    const auto place = halfway_along(measured_[0].segment.line);
    const double lon_deg = place.lon_deg + 20.5 * raster_deg;
    const double lat_deg = place.lat_deg + 19.5 * raster_deg; // column 80, row 40
    for (const auto& [words, share] : std::vector<std::pair<std::vector<std::string>, double>>{
             {{}, 0.5}, {{"--base-opacity", "0.2"}, 0.2}, {{"--base-opacity", "0"}, 0}}) {
        std::vector<std::string> all{
            "-o", out("map.tif"), "--size", "900x900", "--base", base, "--bare", box()};
        all.insert(all.end(), words.begin(), words.end());
        done(all);
        const auto found = colour_at(out("map.tif"), lon_deg, lat_deg);
        ASSERT_EQ(found.size(), 3U);
        EXPECT_NEAR(found[0], ground[0] + (80 - ground[0]) * share, 1);
        EXPECT_NEAR(found[2], ground[2] + (7 - ground[2]) * share, 1);
    }
}

TEST_F(BaseMapProgram, DrawsWithTilesOfPictures) {
    const auto tif = around_the_roads("base.tif");
    const auto tiles = (folder_ / "base.mbtiles").string();
    ASSERT_EQ(output_of(folder_, "gdal_translate -q -of MBTILES " + tif + " " + tiles), "");
    ASSERT_EQ(output_of(folder_, "gdaladdo -q -r average " + tiles), "");
    done({"-o",
          out("map.tif"),
          "--size",
          "900x900",
          "--base",
          tiles,
          "--base-opacity",
          "1",
          "--bare",
          box()});
    const auto place = halfway_along(measured_[0].segment.line);
    const auto found = colour_at(
        out("map.tif"), place.lon_deg + 20.5 * raster_deg, place.lat_deg + 19.5 * raster_deg);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_NEAR(found[0], 80, 2); // the tiles are a picture of it
    EXPECT_NEAR(found[1], 40, 2);
}

TEST_F(BaseMapProgram, NamesWhoseTheBaseMapIs) {
    const auto base = around_the_roads("base.tif", "-mo 'TIFFTAG_COPYRIGHT=© Land Wien'");
    done({"-o", out("map.pdf"), "--base", base});
    EXPECT_THAT(output_of(folder_, "pdftotext " + out("map.pdf") + " -"),
                HasSubstr("Base map: © Land Wien"));
    EXPECT_THAT(output_of(folder_, "pdfinfo " + out("map.pdf")), HasSubstr("© Land Wien"));
    EXPECT_THAT(output_of(folder_, "pdfimages -list " + out("map.pdf")), HasSubstr("image"));
    done({"-o", out("map.tif"), "--base", base, "--bare", box()});
    EXPECT_THAT(output_of(folder_, "gdalinfo " + out("map.tif")),
                HasSubstr("Base map: © Land Wien"));
}

TEST_F(BaseMapProgram, WarnsWhereTheBaseMapLiesElsewhere) {
    const auto base =
        write_raster(folder_ / "far.tif", {"EPSG:4326", -70, -10, 0.001, 20, 20}, place_as_colour)
            .string();
    const auto run = done({"-o", out("map.png"), "--base", base});
    EXPECT_THAT(run.err,
                HasSubstr("macadam: warning: " + base +
                          ": does not overlap the map, which is drawn without it"));
    EXPECT_TRUE(fs::exists(out("map.png")));
    const auto near = done({"-o", out("map.png"), "--base", around_the_roads("base.tif")});
    EXPECT_THAT(near.err, Not(HasSubstr("warning")));
}

TEST_F(BaseMapProgram, SaysWhatIsWrongAndLeavesNothing) {
    const auto base = around_the_roads("base.tif");
    write_file(folder_ / "text.tif", "no raster");
    struct Misuse {
        std::vector<std::string> words;
        int exit_status;
        std::string says;
    };
    const std::vector<Misuse> misuses{
        {{"--base", (folder_ / "none.tif").string()},
         1,
         "none.tif: no such file, expected a base map"},
        {{"--base", (folder_ / "text.tif").string()},
         1,
         "text.tif: is not a raster that GDAL can read"},
        {{"--base", store_},
         1,
         "roads.gpkg: is the road database itself, expected a raster "
         "after --base"},
        {{"--base", base, "--base-opacity", "1.5"}, 2, "--base-opacity is 1.5, expected 0 to 1"},
        {{"--base", base, "--base-opacity", "nan"}, 2, "--base-opacity"},
        {{"--base-opacity", "0.5"}, 2, "--base-opacity requires --base, expected a base map"}};
    for (const auto& misuse : misuses) {
        auto words = misuse.words;
        words.insert(words.begin(), {"-o", out("map.png")});
        const auto run = render(words);
        EXPECT_EQ(run.exit_status, misuse.exit_status) << run.err;
        EXPECT_THAT(run.err, HasSubstr(misuse.says));
        EXPECT_TRUE(fs::is_empty(folder_ / "out"));
    }
}

TEST_F(BaseMapProgram, NeverWritesOverTheBaseMap) {
    const auto base = around_the_roads("base.tif");
    const auto before = read_file(base);
    const auto run = render({"-o", base, "--base", base});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                HasSubstr("base.tif: is also an input, expected another file to write "
                          "to"));
    EXPECT_TRUE(read_file(base) == before);
}

TEST_F(BaseMapProgram, NeverWritesOverWhatAVirtualBaseMapIsMadeOf) {
    const auto source = around_the_roads("source.tif");
    const auto base = (folder_ / "base.vrt").string();
    ASSERT_EQ(output_of(folder_, "gdalbuildvrt -q " + base + " " + source), "");
    const auto before = read_file(source);
    const auto run = render({"-o", source, "--base", base});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                HasSubstr("source.tif: is also an input, expected another file to write to"));
    EXPECT_TRUE(read_file(source) == before);
}

TEST_F(BaseMapProgram, SaysInItsOwnWordsThatASourceIsMissing) {
    const auto source = around_the_roads("source.tif");
    const auto base = (folder_ / "base.vrt").string();
    ASSERT_EQ(output_of(folder_, "gdalbuildvrt -q " + base + " " + source), "");
    fs::remove(source);
    const auto run = render({"-o", out("map.png"), "--base", base, box()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, ::testing::StartsWith("macadam render: " + base + ": cannot be read"));
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(BaseMapProgram, LeavesNothingOnAFullDiskOrWithADamagedBaseMap) {
    const auto base = around_the_roads("base.tif", "-co COMPRESS=DEFLATE");
    for (const auto* name : {"a.png", "a.tif", "a.pdf"}) {
        EXPECT_EQ(render({"-o", out(name), "--base", base}, 3000).exit_status, 1) << name;
        EXPECT_TRUE(fs::is_empty(folder_ / "out")) << name;
    }
    auto bytes = read_file(base);
    std::fill(bytes.begin() + std::ptrdiff_t(bytes.size()) / 2,
              bytes.begin() + std::ptrdiff_t(bytes.size()) * 2 / 3,
              '\x55');
    write_file(base, bytes);
    for (const auto* name : {"a.png", "a.tif", "a.pdf"}) {
        const auto run = render({"-o", out(name), "--base", base});
        EXPECT_EQ(run.exit_status, 1) << name;
        EXPECT_THAT(run.err, HasSubstr("base.tif: cannot be read: ")) << name;
        EXPECT_TRUE(fs::is_empty(folder_ / "out")) << name;
    }
}

} // namespace macadam::testing
