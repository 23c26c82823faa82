// `macadam render` as users run it: what other programs find in its files, and what it refuses.

#include "mapping/network/build_network.hpp"
#include "storage/store/road_store.hpp"
#include "support/program/picture_program.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class RenderProgram : public PictureProgram {
protected:
    void expect_done(const std::vector<std::string>& words) const {
        const auto run = render(words);
        EXPECT_EQ(run.exit_status, 0) << run.err;
    }

    void expect_nothing_left() const { EXPECT_TRUE(fs::is_empty(folder_ / "out")); }

    Json info(const std::string& file) const {
        return Json::parse(output_of(folder_, "gdalinfo -json " + file));
    }

    /// The colour there, as GDAL finds it.
    std::vector<int> colour_at(const std::string& file, const GeoPoint& at) const {
        std::istringstream in{
            output_of(folder_,
                      fmt::format("gdallocationinfo -valonly -wgs84 {} {:.9f} {:.9f}",
                                  file,
                                  at.lon_deg,
                                  at.lat_deg))};
        std::vector<int> bands;
        for (int value = 0; in >> value;) {
            bands.push_back(value);
        }
        return bands;
    }
};

const std::vector<int> ground{0xf4, 0xf4, 0xf2};

TEST_F(RenderProgram, DrawsRoadsWhereTheyAreInTheWorld) {
    ASSERT_FALSE(measured_.empty());
    for (const auto* crs : {"EPSG:3857", "EPSG:2154", "EPSG:3035"}) {
        const auto file = out("map.tif");
        expect_done({"-o", file, "--bare", "--size", "1200x900", "--crs", crs});
        for (const auto& record : measured_) {
            const auto middle = halfway_along(record.segment.line);
            const auto found = colour_at(file, middle);
            EXPECT_EQ(found.size(), 3U) << crs;
            EXPECT_NE(found, ground) << crs;
            EXPECT_EQ(colour_at(file, {middle.lat_deg - 1e-4, middle.lon_deg}), ground) << crs;
        }
    }
}

TEST_F(RenderProgram, WritesAPictureThatFillsItsBoxToTheEdges) {
    expect_done({"-o", out("map.tif"), "--bare", "--bbox", "4.8,45.7,4.9,45.8"});
    const auto found = info(out("map.tif"));
    const auto transform = found["geoTransform"];
    const double per_px = transform[1].get<double>();
    // Spherical Mercator by its formula (Snyder, eqs. 7-1 and 7-2).
    const double radius_m = 6378137;
    const double west_m = radius_m * 4.8 * M_PI / 180;
    const double width_m = radius_m * 0.1 * M_PI / 180;
    const double north_m = radius_m * std::asinh(std::tan(45.8 * M_PI / 180));
    EXPECT_NEAR(transform[0].get<double>(), west_m, per_px / 2);
    EXPECT_NEAR(transform[3].get<double>(), north_m, per_px / 2);
    EXPECT_NEAR(found["size"][0].get<int>() * per_px, width_m, per_px);
    EXPECT_EQ(found["size"][1], 1200); // the box is higher than the picture asked for
}

TEST_F(RenderProgram, WritesAWorldFileThatSaysTheSameAsAGeoTiff) {
    const std::vector<std::string> size{"--size", "800x600", "--crs", "EPSG:2154"};
    std::vector<std::string> words{"-o", out("map.tif")};
    words.insert(words.end(), size.begin(), size.end());
    expect_done(words);
    words[1] = out("map.png");
    words.emplace_back("--world-file");
    expect_done(words);
    const auto tif = info(out("map.tif"));
    const auto png = info(out("map.png"));
    for (int i = 0; i < 6; ++i) {
        EXPECT_NEAR(
            tif["geoTransform"][i].get<double>(), png["geoTransform"][i].get<double>(), 1e-6);
    }
    EXPECT_THAT(png["coordinateSystem"]["wkt"].get<std::string>(), HasSubstr("ID[\"EPSG\",2154]"));
    EXPECT_TRUE(fs::exists(out("map.pgw")));
    EXPECT_TRUE(fs::exists(out("map.png.aux.xml")));
}

TEST_F(RenderProgram, DrawsThePictureOfMercatorByteForByteAsWithoutAProjection) {
    expect_done({"-o", out("a.png"), "--size", "400x300"});
    expect_done({"-o", out("b.png"), "--size", "400x300", "--crs", "epsg:3857"});
    EXPECT_TRUE(read_file(out("a.png")) == read_file(out("b.png")));
}

TEST_F(RenderProgram, DrawsPicturesThatAreWiderThanOneWindow) {
    expect_done({"-o", out("wide.png"), "--size", "32768x600"});
    EXPECT_EQ(info(out("wide.png"))["size"], Json::parse("[32768, 600]"));
}

TEST_F(RenderProgram, TakesTheSizeOfAPictureOnPaper) {
    expect_done({"-o", out("a5.png"), "--size", "a5", "--landscape", "--dpi", "150"});
    EXPECT_EQ(info(out("a5.png"))["size"], Json::parse("[1240, 874]"));
    expect_done({"-o", out("mm.png"), "--size", "100x50.8mm"});
    EXPECT_EQ(info(out("mm.png"))["size"], Json::parse("[1181, 600]")); // at 300 dpi
}

TEST_F(RenderProgram, WritesAMapOnPaper) {
    expect_done({"-o", out("map.pdf"), "--paper", "a3", "--landscape", "--title", "Lyon"});
    EXPECT_THAT(output_of(folder_, "pdfinfo " + out("map.pdf")), HasSubstr("(A3)"));
    EXPECT_THAT(output_of(folder_, "pdftotext " + out("map.pdf") + " -"), HasSubstr("Lyon"));
}

TEST_F(RenderProgram, StatesItsScaleOnPaper) {
    for (const auto* scale : {"25000", "1:25000"}) {
        expect_done({"-o", out("map.pdf"), "--scale", scale});
        EXPECT_THAT(output_of(folder_, "pdftotext " + out("map.pdf") + " -"),
                    HasSubstr("1:25,000"));
    }
}

TEST_F(RenderProgram, GoesOnOverTheAntimeridian) {
    auto ways = road_art("A---B C---D", 5, {"AB", "CD"}).ways; // of Viti Levu and of Lau
    ways[0].line = {{-17, 179.8}, {-17.01, 179.8}};
    ways[1].line = {{-17, -179.8}, {-17.01, -179.8}};
    store_ = (folder_ / "fiji.gpkg").string();
    RoadStore::create(store_, build_network(std::move(ways), 20), settings());
    const auto file = out("map.tif");
    expect_done(
        {"-o", file, "--bare", "--bbox", "179.7,-17.1,-179.7,-16.9", "--size", "2000x2000"});
    const double per_px = info(file)["geoTransform"][1].get<double>();
    const double left_m = info(file)["geoTransform"][0].get<double>();
    const double meridian_px = (6378137 * M_PI - left_m) / per_px;
    EXPECT_NEAR(meridian_px, info(file)["size"][0].get<int>() / 2.0, 1);
    // The longitudes of the file go on beyond 180 degrees.
    for (const double lon_deg : {179.8, 180.2, 180.0}) {
        const auto pixel =
            output_of(folder_,
                      fmt::format("gdallocationinfo -valonly -geoloc {} {:.3f} {:.3f}",
                                  file,
                                  6378137 * lon_deg * M_PI / 180,
                                  6378137 * std::asinh(std::tan(-17.005 * M_PI / 180))));
        EXPECT_EQ(pixel == "244\n244\n242\n", lon_deg == 180.0) << pixel;
    }
}

struct Misuse {
    std::vector<std::string> words; ///< after the store; OUT is the folder
    int exit_status;
    std::string says;
};

TEST_F(RenderProgram, SaysWhatIsWrongAndLeavesNothing) {
    const std::vector<Misuse> misuses{
        {{"-o", "OUT/a.jpg"},
         2,
         "-o is 'OUT/a.jpg', expected a name that ends in .png, .tif or .pdf"},
        {{"-o", "OUT/a.pdf", "--size", "512x512"},
         2,
         "--size is '512x512', expected for a .pdf millimetres such as 420x594mm, or --paper"},
        {{"-o", "OUT/a.pdf", "--dpi", "300"}, 2, "--dpi is for pictures"},
        {{"-o", "OUT/a.pdf", "--size", "A4", "--paper", "A4"},
         2,
         "--paper and --size cannot be combined"},
        {{"-o", "OUT/a.png", "--scale", "1:many"},
         2,
         "--scale is '1:many', expected 100 to 100000000, such as 25000 or 1:25000"},
        {{"-o", "OUT/a.png", "--scale", "99"}, 2, "--scale is '99', expected 100 to"},
        {{"-o", "OUT/a.png", "--scale", "25000", "--bare"},
         2,
         "--scale and --bare cannot be combined"},
        {{"-o", "OUT/a.png", "--size", "large"}, 2, "--size is 'large', expected pixels such as"},
        {{"-o", "OUT/a.png", "--size", "A0", "--dpi", "1200"},
         2,
         "--size is 'A0', which is 39732 x 56173 pixels at 1200 dpi, expected both from 256"},
        {{"-o", "OUT/a.png", "--size", "A4", "--dpi", "5"}, 2, "--dpi is '5', expected 24 to 1200"},
        {{"-o", "OUT/a.png", "--colour-by", "age", "--ramp", "viridis"},
         2,
         "--colour-by age and --ramp cannot be combined"},
        {{"-o", "OUT/a.png", "--size", "32769x512"},
         2,
         "--size is '32769x512', expected WxH with both from 256 to 32768 pixels"},
        {{"-o", "OUT/a.tif", "--size", "512x32769"},
         2,
         "--size is '512x32769', expected WxH with both from 256 to 32768 pixels"},
        {{"-o", "OUT/a.png", "--paper", "A4"}, 2, "--paper is for a .pdf, expected --size A4"},
        {{"-o", "OUT/a.png", "--landscape"}, 2, "--landscape turns paper, expected --size A4"},
        {{"-o", "OUT/a.pdf", "--paper", "A9"},
         2,
         "--paper is 'A9', expected A4 or A0 or A1 or A2 or A3 or A5 or letter or legal or "
         "tabloid"},
        {{"-o", "OUT/a.png", "--crs", ""}, 2, "--crs is '', expected a projection such as"},
        {{"-o", "OUT/a.tif", "--world-file"}, 2, "--world-file is for a .png"},
        {{"-o", "OUT/a.png", "--bbox", "10,5,10,6"}, 2, "--bbox is 10,5,10,6, expected west,south"},
        {{"-o", "OUT/a.png", "--bbox", "10,6,11,5"}, 2, "with south < north"},
        {{"-o", "OUT/a.png", "--bbox=-190,5,11,6"}, 2, "--bbox is -190,5,11,6"},
        {{"-o", "OUT/a.png", "--bbox", "nan,5,11,6"}, 2, "--bbox"},
        {{"-o", "OUT/a.png", "--bbox", "10,50,11,51"},
         1,
         "nothing to draw: the database has "
         "no road"},
        {{"-o", "OUT/a.png", "--bbox=-180,-86,180,86"},
         1,
         "expected longitudes within 180 and latitudes within 85 degrees"},
        {{"-o", "OUT/a.png", "--crs", "EPSG:999999"},
         1,
         "the projection 'EPSG:999999': is unknown to PROJ, expected a projected or geographic"},
        {{"-o", "OUT/a.tif", "--crs", "EPSG:4978"}, 1, "is not a coordinate reference system"},
        {{"-o", "OUT/a.pdf", "--crs", "+proj=ortho +lat_0=-45 +lon_0=180"},
         1,
         "(latitude, longitude), expected a box within its reach"},
        {{"-o", "OUT/none/a.png"}, 1, "a.png: cannot be written: No such file or directory"},
        {{"-o", "OUT/none/a.png", "--world-file"}, 1, "a.png: cannot be written: No such file"},
        {{"-o", "OUT/none/a.tif"}, 1, "a.tif: cannot be written: No such file or directory"},
        {{"-o", "OUT/none/a.pdf"}, 1, "a.pdf: cannot be written: No such file or directory"},
    };
    for (const auto& misuse : misuses) {
        auto words = misuse.words;
        auto says = misuse.says;
        for (auto* text : {&words[1], &says}) {
            if (const auto at = text->find("OUT"); at != std::string::npos) {
                text->replace(at, 3, (folder_ / "out").string());
            }
        }
        const auto run = render(words);
        EXPECT_EQ(run.exit_status, misuse.exit_status) << run.err;
        EXPECT_THAT(run.err, HasSubstr(says));
        expect_nothing_left();
    }
}

TEST_F(RenderProgram, LeavesNothingOnAFullDisk) {
    for (const auto* name : {"a.png", "b.png", "a.tif", "a.pdf"}) {
        for (const std::size_t max_bytes : {1000, 6000}) {
            std::vector<std::string> words{"-o", out(name)};
            if (name == std::string{"a.png"}) {
                words.emplace_back("--world-file");
            }
            const auto run = render(words, max_bytes);
            EXPECT_EQ(run.exit_status, 1) << name;
            EXPECT_THAT(run.err, HasSubstr("cannot be written")) << name;
            expect_nothing_left();
        }
    }
}

TEST_F(RenderProgram, NeverWritesOverTheStoreThatItReads) {
    fs::copy_file(store_, out("store.png"));
    const auto before = read_file(out("store.png"));
    const auto run = run_macadam({"render", out("store.png"), "-o", out("store.png")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                HasSubstr("store.png: is also an input, expected another file to write to"));
    EXPECT_TRUE(read_file(out("store.png")) == before);
}

} // namespace
} // namespace macadam::testing
