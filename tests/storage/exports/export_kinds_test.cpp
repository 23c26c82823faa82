// What is particular to single kinds of files, as GDAL's own tools find it.

#include "mapping/network/build_network.hpp"
#include "storage/exports/export.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/text/utc.hpp"
#include "support/files/files.hpp"
#include "support/files/gdal_reading.hpp"
#include "support/program/shell.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// --------------------------------------------------------------------------------- antimeridian

/// A store whose road steps over the meridian of 180 degrees, as on Taveuni. (No map is read with
/// such a road; the line is put into the store afterwards.)
StoreReader store_of_taveuni(const fs::path& file) {
    RoadStore::create(file, build_network(road_art("A---B", 5, {"AB"}).ways, 40), settings());
    {
        const std::vector<GeoPoint> line{{-16.8, 179.9999}, {-16.8, -179.9999}};
        Database database{file, Database::Access::write};
        add_geometry_functions(database);
        database.prepare("UPDATE segment SET geom = ?").run(Blob{geometry_of(line)});
    }
    return StoreReader::open(file);
}

json geometry_by_gdal(const std::string& suffix) {
    const auto folder = test_folder();
    const auto store = store_of_taveuni(folder / "store.gpkg");
    SegmentFilter way;
    way.with_state_only = false;
    EXPECT_EQ(export_segments(store, way, folder / ("out" + suffix)), 2U);
    return collection_by_gdal(folder, "out" + suffix)["features"][0]["geometry"];
}

TEST(ExportOverTheAntimeridian, CutsTheLinesOfGeoJsonAsRfc7946Asks) {
    for (const auto* suffix : {".geojson", ".geojsonl", ".kml", ".shp"}) {
        const auto geometry = geometry_by_gdal(suffix);
        EXPECT_EQ(geometry["type"], "MultiLineString") << suffix;
        const auto& parts = geometry["coordinates"];
        ASSERT_THAT(parts, SizeIs(2)) << suffix;
        expect_line(parts[0], {{-16.8, 179.9999}, {-16.8, 180}}, seven_decimals_deg);
        expect_line(parts[1], {{-16.8, -180}, {-16.8, -179.9999}}, seven_decimals_deg);
    }
}

TEST(ExportOverTheAntimeridian, LetsLongitudesGoOnInTablesOfLines) {
    for (const auto* suffix : {".gpkg", ".fgb"}) {
        const auto geometry = geometry_by_gdal(suffix);
        EXPECT_EQ(geometry["type"], "LineString");
        expect_line(
            geometry["coordinates"], {{-16.8, 179.9999}, {-16.8, 180.0001}}, seven_decimals_deg);
    }
}

TEST(ExportOverTheAntimeridian, HasTheMiddleInCsvWhereTheRoadIs) {
    const auto folder = test_folder();
    const auto store = store_of_taveuni(folder / "store.gpkg");
    SegmentFilter all;
    all.with_state_only = false;
    export_segments(store, all, folder / "out.csv");
    EXPECT_THAT(content_of(folder / "out.csv"), HasSubstr(",-16.8000000,180.0000000"));
}

// ------------------------------------------------------------------------------------ Shapefile

TEST(Shapefile, IsASetOfFiveFilesWithTheirStyle) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    fs::create_directory(folder / "out");
    written(folder / "out", "roads.qix", "an index of other roads");
    export_segments(store, {}, folder / "out" / "roads.shp");
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator{folder / "out"}) {
        found.push_back(entry.path().filename().string());
    }
    std::ranges::sort(found);
    EXPECT_THAT(found,
                ElementsAre("roads.cpg",
                            "roads.dbf",
                            "roads.prj",
                            "roads.qml",
                            "roads.shp",
                            "roads.shx",
                            "roads.sld"));
    EXPECT_EQ(content_of(folder / "out" / "roads.cpg"), "UTF-8");
}

TEST(Shapefile, ShowsItsRoughnessAsTypedColumns) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_segments(store, {}, folder / "out.shp");
    const auto info = output_of(folder, "ogrinfo -ro -so -al " + (folder / "out.shp").string());
    for (const auto* line : {"Geometry: Line String",
                             "Feature Count: 20",
                             "GEOGCRS[\"WGS 84\"",
                             "way_id: Integer64 (18.0)",
                             "iri: Real (13.3)",
                             "from_m: Real (13.2)",
                             "trend_year: Real (13.3)",
                             "passes: Integer64",
                             "first_seen: Date"}) {
        EXPECT_THAT(info, HasSubstr(line));
    }
}

TEST(Shapefile, IsTheSameByteForByteOnAnyDay) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_segments(store, {}, folder / "out.shp");
    // The second to fourth byte of a .dbf: the day of the last pass, 2027-02-21 of trip 5 or so.
    const auto last_seen_ms = *store.info().last_seen_ms;
    const auto day = utc_text(last_seen_ms);
    const auto dbf = content_of(folder / "out.dbf");
    EXPECT_EQ(1900 + int(static_cast<unsigned char>(dbf[1])), std::stoi(day.substr(0, 4)));
    EXPECT_EQ(int(dbf[2]), std::stoi(day.substr(5, 2)));
    EXPECT_EQ(int(dbf[3]), std::stoi(day.substr(8, 2)));
}

TEST(Shapefile, CanBeEmpty) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    EXPECT_EQ(export_segments(store, {}, folder / "out.shp"), 0U);
    EXPECT_THAT(output_of(folder, "ogrinfo -ro -so -al " + (folder / "out.shp").string()),
                HasSubstr("Feature Count: 0"));
}

TEST(Shapefile, RefusesIdsThatItsNumbersCannotHold) {
    const auto folder = test_folder();
    auto ways = road_art("A---B", 10, {"AB"}).ways;
    ways.front().id = 1'234'567'890'123'456'789;
    const auto store =
        RoadStore::create(folder / "a.gpkg", build_network(std::move(ways), 20), settings());
    SegmentFilter all;
    all.with_state_only = false;
    EXPECT_THAT(
        refusal_of([&] { export_segments(store, all, folder / "out.shp"); }),
        HasSubstr("out.shp: a way_id has 19 digits, expected at most the 18 of a Shapefile"));
    EXPECT_FALSE(fs::exists(folder / "out.shp"));
}

// ------------------------------------------------------------------------------------------ KML

TEST(Kml, HasAStyleForEachClassOfTheStoresTable) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_segments(store, {}, folder / "out.kml");
    const auto kml = content_of(folder / "out.kml");
    for (const auto* style : {"<Style id=\"good\"><LineStyle><color>ffb67b2c</color>",
                              "<Style id=\"fair\"><LineStyle><color>ff90e0fe</color>",
                              "<Style id=\"poor\"><LineStyle><color>ff1c19d7</color>"}) {
        EXPECT_THAT(kml, HasSubstr(style));
    }
    const auto collection = collection_by_gdal(folder, "out.kml");
    for (const auto& feature : collection["features"]) {
        const auto name = feature["properties"]["class"].get<std::string>();
        EXPECT_THAT(kml, HasSubstr("<styleUrl>#" + name + "</styleUrl>"));
    }
}

TEST(Kml, NamesWhoseRoadsTheyAre) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    export_segments(store, {}, folder / "out.kml");
    EXPECT_THAT(content_of(folder / "out.kml"),
                HasSubstr("Roughness (IRI, mm/m). © &quot;Mappers&quot;"));
}

} // namespace
} // namespace macadam::testing
