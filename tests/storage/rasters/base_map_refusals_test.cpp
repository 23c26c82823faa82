// What is no base map, and how it is told.

#include "base_map_places.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(BaseMapFile, RefusesWhatIsNoMapOfColours) {
    const auto folder = test_folder();
    const auto refusal = [&](const fs::path& file) {
        return refusal_of([&] { open_base_map(file); });
    };
    EXPECT_EQ(refusal(folder / "none.tif"),
              (folder / "none.tif").string() + ": no such file, expected a base map");
    EXPECT_THAT(refusal(folder), HasSubstr("is a folder, expected a base map"));
    EXPECT_THAT(refusal(written(folder, "text.tif", "no raster")),
                AllOf(HasSubstr("text.tif: is not a raster that GDAL can read: "),
                      HasSubstr("not recognized")));
    EXPECT_THAT(refusal(written(folder, "empty.tif", "")),
                HasSubstr("is not a raster that GDAL can read"));
    EXPECT_THAT(
        refusal(written(folder,
                        "lines.geojson",
                        R"({"type":"FeatureCollection","features":[{"type":"Feature",)"
                        R"("properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}]})")),
        HasSubstr("lines.geojson: contains points, lines or areas, expected a raster"));

    const auto wide = folder / "wide.tif";
    ASSERT_EQ(output_of(folder,
                        "gdal_create -q -outsize 4 4 -bands 1 -ot UInt16 -a_srs EPSG:3857 -a_ullr "
                        "0 4 4 0 " +
                            wide.string()),
              "");
    EXPECT_EQ(refusal(wide),
              wide.string() + ": contains numbers of type UInt16, expected 8-bit colours; "
                              "convert it with gdal_translate -ot Byte -scale");
    const auto many = folder / "many.tif";
    ASSERT_EQ(output_of(folder,
                        "gdal_create -q -outsize 4 4 -bands 7 -co PHOTOMETRIC=MINISBLACK -a_srs "
                        "EPSG:3857 -a_ullr 0 4 4 0 " +
                            many.string()),
              "");
    EXPECT_EQ(refusal(many),
              many.string() + ": has 7 bands without colour interpretation, expected grey, a "
                              "palette, or red, green and blue; gdal_translate -b selects bands");
}

TEST(BaseMapFile, RefusesVectorTilesByTheirName) {
    const auto folder = test_folder();
    const auto lines =
        written(folder,
                "lines.geojson",
                R"({"type":"FeatureCollection","features":[{"type":"Feature",)"
                R"("properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}]})");
    const auto file = folder / "map.mbtiles";
    ASSERT_EQ(
        output_of(folder,
                  "ogr2ogr -f MBTILES -dsco MAXZOOM=3 " + file.string() + " " + lines.string()),
        "");
    EXPECT_EQ(refusal_of([&] { open_base_map(file); }),
              file.string() + ": contains vector tiles, expected picture tiles");
}

TEST(BaseMapFile, RefusesWhatDoesNotSayWhereItLies) {
    const auto folder = test_folder();
    const auto created = [&](const std::string& options) {
        auto file = folder / "map.png";
        EXPECT_EQ(output_of(folder,
                            "gdal_create -q -of GTiff -outsize 4 4 -bands 3 " + options + " " +
                                (folder / "map.tif").string()),
                  "");
        return folder / "map.tif";
    };
    EXPECT_THAT(refusal_of([&] { open_base_map(created("-a_ullr 0 4 4 0")); }),
                HasSubstr("map.tif: has no coordinate system, expected a georeferenced raster; "
                          "assign one with gdal_translate -a_srs EPSG:..."));
    EXPECT_THAT(refusal_of([&] { open_base_map(created("-a_srs EPSG:3857")); }),
                HasSubstr("map.tif: is not georeferenced, expected a georeferenced raster; add "
                          "a world file or use gdal_translate -a_ullr"));
}

TEST(BaseMapFile, FetchesNothingFromTheNetwork) {
    const auto folder = test_folder();
    const auto service =
        written(folder,
                "service.xml",
                R"(<GDAL_WMS><Service name="TMS"><ServerUrl>http://127.0.0.1:9/)"
                R"(${z}/${x}/${y}.png</ServerUrl></Service><DataWindow>)"
                R"(<UpperLeftX>-20037508</UpperLeftX><UpperLeftY>20037508</UpperLeftY>)"
                R"(<LowerRightX>20037508</LowerRightX><LowerRightY>-20037508</LowerRightY>)"
                R"(<TileLevel>3</TileLevel></DataWindow><Projection>EPSG:3857</Projection>)"
                R"(<BandsCount>3</BandsCount></GDAL_WMS>)");
    EXPECT_THAT(refusal_of([&] { open_base_map(service); }),
                HasSubstr("service.xml: is not a raster that GDAL can read"));
}

/// A port of this machine that counts who calls.
class Listener {
public:
    Listener() : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)} {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        auto* const any = reinterpret_cast<sockaddr*>(&address);
        socklen_t size = sizeof address;
        EXPECT_EQ(::bind(socket_, any, size), 0);
        EXPECT_EQ(::listen(socket_, 8), 0);
        EXPECT_EQ(::getsockname(socket_, any, &size), 0);
        port_ = ntohs(address.sin_port);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener() { ::close(socket_); }

    int port() const { return port_; }
    bool was_called() const { return ::accept(socket_, nullptr, nullptr) >= 0; }

private:
    int socket_;
    int port_ = 0;
};

TEST(BaseMapFile, FetchesNoSourcesOfAVirtualRasterFromTheNetwork) {
    const auto folder = test_folder();
    const Listener listener;
    for (const auto* system : {"/vsicurl/", "/vsicurl_streaming/", "/vsizip/vsicurl_streaming/"}) {
        const auto file = written(
            folder,
            "far.vrt",
            fmt::format(R"(<VRTDataset rasterXSize="4" rasterYSize="4"><SRS>EPSG:3857</SRS>)"
                        R"(<GeoTransform>0,10,0,40,0,-10</GeoTransform>)"
                        R"(<VRTRasterBand dataType="Byte" band="1"><SimpleSource>)"
                        R"(<SourceFilename>{}http://127.0.0.1:{}/x.tif</SourceFilename>)"
                        R"(<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>)"
                        R"(</VRTDataset>)",
                        system,
                        listener.port()));
        EXPECT_THAT(refusal_of([&] {
                        whole(open_base_map(file), {"", 0, 40, 10, 4, 4});
                    }),
                    HasSubstr("far.vrt: "))
            << system;
        EXPECT_FALSE(listener.was_called()) << system;
    }
}

TEST(BaseMapFile, NamesTheFilesThatItIsReadFrom) {
    const auto folder = test_folder();
    const auto tif =
        write_raster(folder / "map.tif", {"EPSG:3857", 0, 40, 10, 4, 4}, place_as_colour);
    const auto inner = folder / "inner.vrt";
    const auto outer = folder / "outer.vrt";
    for (const auto& [from, to] : {std::pair{tif, inner}, std::pair{inner, outer}}) {
        ASSERT_EQ(output_of(folder, "gdalbuildvrt -q " + to.string() + " " + from.string()), "");
    }
    EXPECT_THAT(open_base_map(outer).files,
                ::testing::IsSupersetOf({outer.string(), inner.string(), tif.string()}));
}

TEST(BaseMapFile, TellsOfAFileThatIsDamagedInside) {
    const auto folder = test_folder();
    const auto file = write_raster(
        folder / "map.tif",
        {"EPSG:3857", 0, 4000, 10, 400, 400, "-co COMPRESS=DEFLATE"},
        [](int x, int y) {
            return std::vector<std::uint8_t>{std::uint8_t(x * y), std::uint8_t(x + y), 3};
        });
    const auto map = [&] {
        auto bytes = content_of(file);
        std::fill(bytes.begin() + std::ptrdiff_t(bytes.size()) / 3,
                  bytes.begin() + std::ptrdiff_t(bytes.size()) / 2,
                  '\x55');
        written(folder, "map.tif", bytes);
        return open_base_map(file);
    }();
    EXPECT_THAT(refusal_of([&] {
                    whole(map, {"", 0, 4000, 10, 400, 400});
                }),
                HasSubstr("map.tif: cannot be read: "));
}

} // namespace
} // namespace macadam::testing
