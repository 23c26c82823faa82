#include "storage/exports/export.hpp"

#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/text/json.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace macadam {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::import_trips;
using testing::new_store;
using ::testing::Not;
using testing::refusal_of;
using ::testing::SizeIs;
using testing::test_folder;

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// What a system command says on both streams, by way of a file in the folder.
std::string output_of(const std::filesystem::path& folder, const std::string& command) {
    const auto log = folder / "output.txt";
    const int status = std::system((command + " >" + log.string() + " 2>&1").c_str());
    return content_of(log) + (status == 0 ? "" : "\nexit " + std::to_string(status));
}

SegmentFilter all_segments() {
    SegmentFilter filter;
    filter.with_state_only = false;
    return filter;
}

/// A record whose every value is known.
SegmentRecord record() {
    const SegmentKey key{1234, false, 7};
    return {.segment = {key, 140.004, 160.006, {{50.123456789, 10.00000004}, {50.1236, -10}}},
            .name = "=A, \"B\"",
            .highway = "residential",
            .state = SegmentState{.segment = key,
                                  .iri_um = 2345,
                                  .sd_um = 300,
                                  .low_um = 1852,
                                  .high_um = 2839,
                                  .left_um = 2400,
                                  .right_um = std::nullopt,
                                  .centre_only = false,
                                  .validity = 2,
                                  .passes = 5,
                                  .vehicles = 3,
                                  .first_seen_ms = 1'533'226'488'225,
                                  .last_seen_ms = 1'533'226'489'000,
                                  .trend_um_per_year = -51,
                                  .trend_sd_um_per_year = 20,
                                  .change = RoadChange{1'533'226'488'225, -812}}};
}

const ClassTable& fhwa() {
    return *class_table("fhwa");
}

TEST(Export, WritesAFeatureInTheWordsOfRfc7946) {
    const auto shown = record();
    EXPECT_EQ(geojson_feature({shown, fhwa()}),
              R"({"type":"Feature","id":"1234-0007","geometry":{"type":"LineString",)"
              R"("coordinates":[[10.0000000,50.1234568],[-10.0000000,50.1236000]]},"properties":{)"
              R"("segment":"1234-0007","way_id":1234,"name":"=A, \"B\"","highway":"residential",)"
              R"("direction":"backward","from_m":140.00,"to_m":160.01,"iri":2.345,"iri_sd":0.300,)"
              R"("iri_low":1.852,"iri_high":2.839,"iri_left":2.400,"iri_right":null,"index":"MRI",)"
              R"("class":"fair","passes":5,"vehicles":3,"first_seen":"2018-08-02",)"
              R"("last_seen":"2018-08-02","trend_per_year":-0.051,"trend_sd":0.020,)"
              R"("changed":"2018-08-02","change":-0.812,"validity":"start_up"}})");
}

TEST(Export, WritesACsvRowWithTheSameValues) {
    auto even = record();
    even.segment.line = {{50, 10}, {50.001, 10}, {50.002, 10}};
    EXPECT_EQ(csv_header(segment_columns()),
              "segment,way_id,name,highway,direction,from_m,to_m,iri,iri_sd,iri_low,iri_high,"
              "iri_left,iri_right,index,class,passes,vehicles,first_seen,last_seen,trend_per_year,"
              "trend_sd,changed,change,validity,lat_deg,lon_deg\n");
    EXPECT_EQ(csv_line(segment_columns(), {even, fhwa()}),
              "1234-0007,1234,\"'=A, \"\"B\"\"\",residential,backward,140.00,160.01,2.345,0.300,"
              "1.852,2.839,2.400,,MRI,fair,5,3,2018-08-02,2018-08-02,"
              "-0.051,0.020,2018-08-02,-0.812,start_up,50.0010000,10.0000000\n");
}

TEST(Export, MakesTextOfWhatASpreadsheetWouldRun) {
    for (const auto* name : {"=1", "+1", "-1", "@a"}) {
        auto odd = record();
        odd.name = name;
        EXPECT_THAT(csv_line(segment_columns(), {odd, fhwa()}),
                    HasSubstr(",\"'" + std::string{name} + "\","));
    }
}

TEST(Export, LeavesUnknownValuesEmpty) {
    auto unknown = record();
    unknown.state.reset();
    unknown.name = "";
    const auto properties = json::parse(geojson_feature({unknown, fhwa()}))["properties"];
    for (const auto* name : {"name", "iri", "iri_sd", "class", "index", "first_seen", "validity"}) {
        EXPECT_TRUE(properties[name].is_null()) << name;
    }
    EXPECT_EQ(properties["passes"], 0);
    EXPECT_THAT(csv_line(segment_columns(), {unknown, fhwa()}),
                HasSubstr("1234,,residential,backward,140.00,160.01,,,,,,,,,0,0,,,,,,,,50."));
}

TEST(Export, MakesOneCollectionOfAllSegments) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 3);
    EXPECT_EQ(export_segments(store, {}, folder / "out.geojson"), 20U);
    const auto collection = json::parse(content_of(folder / "out.geojson"));
    EXPECT_EQ(collection["type"], "FeatureCollection");
    EXPECT_EQ(collection["attribution"], testing::settings().attribution);
    ASSERT_THAT(collection["features"], SizeIs(20));
    std::size_t i = 0;
    store.visit({}, [&](const SegmentRecord& each) {
        const auto& feature = collection["features"][i++];
        EXPECT_EQ(feature["id"], name_of(each.segment.key));
        EXPECT_NEAR(feature["properties"]["iri"].get<double>(), each.state->iri_um / 1000.0, 1e-9);
        EXPECT_NEAR(feature["geometry"]["coordinates"][0][1].get<double>(),
                    each.segment.line[0].lat_deg,
                    6e-8); // 7 decimals
    });
}

TEST(Export, WritesAnEmptyCollectionWhereNothingIsKnown) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    EXPECT_EQ(export_segments(store, {}, folder / "out.geojson"), 0U);
    EXPECT_TRUE(json::parse(content_of(folder / "out.geojson"))["features"].empty());
}

TEST(Export, WritesALineOfTextForEachSegment) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 1);
    EXPECT_EQ(export_segments(store, {}, folder / "out.geojsonl"), 20U);
    std::istringstream lines{content_of(folder / "out.geojsonl")};
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        EXPECT_EQ(json::parse(line)["type"], "Feature");
    }
    EXPECT_EQ(count, 20U);
    const auto all = export_segments(store, all_segments(), folder / "out.csv");
    const auto csv = content_of(folder / "out.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), all + 1);
}

TEST(Export, RefusesSuffixesItDoesNotKnow) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    EXPECT_THAT(
        refusal_of([&] { export_segments(store, {}, folder / "out.xls"); }),
        HasSubstr("out.xls: suffix '.xls', expected one of .geojson, .geojsonl, .csv, .gpkg, "
                  ".fgb, .shp, .kml"));
}

TEST(Export, LeavesNothingOfAFileThatCouldNotBeFinished) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 1);
    std::stop_source source;
    source.request_stop();
    std::filesystem::create_directory(folder / "out");
    for (const auto suffix : export_suffixes()) {
        const auto file = folder / "out" / ("a" + std::string{suffix});
        EXPECT_THAT(refusal_of([&] {
                        export_segments(store, {}, file, {{}, source.get_token()});
                    }),
                    HasSubstr("stopped"));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder / "out"));
}

// ---------------------------------------------------------------------------------- GeoPackage

TEST(GeoPackage, PutsALineIntoBytesAndBack) {
    const std::vector<GeoPoint> line{{50.1, 10.2}, {-33.25, 179.999999999}, {0, -1e-9}};
    EXPECT_EQ(line_of_geometry(geometry_of(line)), line);
    EXPECT_TRUE(line_of_geometry("GP").empty());
    EXPECT_TRUE(line_of_geometry(geometry_of(line).substr(0, 60)).empty());
}

TEST(GeoPackage, PassesTheValidatorOfGdal) {
    const auto folder = test_folder();
    auto store = new_store(folder / "fresh.gpkg");
    std::filesystem::copy_file(folder / "fresh.gpkg", folder / "driven.gpkg");
    auto driven = RoadStore::open(folder / "driven.gpkg");
    import_trips(driven, 6);
    export_segments(driven, {}, folder / "export.gpkg");
    for (const auto* name : {"fresh.gpkg", "driven.gpkg", "export.gpkg"}) {
        // Types of data of an extension are allowed since version 1.2 (requirement 17 has gone, as
        // the validator says beside its check): it reads the file without them.
        Database{folder / name, Database::Access::write}.run(
            "DELETE FROM gpkg_contents WHERE data_type = 'macadam_inner_table'");
        EXPECT_EQ(output_of(folder,
                            "/usr/bin/python3 -m osgeo_utils.samples.validate_gpkg " +
                                (folder / name).string()),
                  "")
            << name;
    }
}

TEST(GeoPackage, ShowsItsRoughnessAsTypedColumns) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_segments(store, {}, folder / "export.gpkg");
    for (const auto* name : {"a.gpkg", "export.gpkg"}) {
        const auto info =
            output_of(folder, "ogrinfo -ro -so " + (folder / name).string() + " roughness");
        for (const auto* line : {"Geometry: Line String",
                                 "Feature Count: 20",
                                 "segment: String",
                                 "way_id: Integer64",
                                 "iri: Real",
                                 "class: String",
                                 "passes: Integer",
                                 "first_seen: Date (0.0)",
                                 "trend_per_year: Real"}) {
            EXPECT_THAT(info, HasSubstr(line)) << name;
        }
    }
}

TEST(GeoPackage, ExportsNoTripsPassesOrVehicles) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_segments(store, {}, folder / "export.gpkg");
    Database exported{folder / "export.gpkg", Database::Access::read};
    auto select = exported.prepare("SELECT group_concat(name, ' ') FROM sqlite_master"
                                   " WHERE type = 'table' AND name NOT LIKE 'gpkg%'"
                                   " AND name NOT LIKE 'rtree%' AND name NOT LIKE 'sqlite%'");
    select.step();
    EXPECT_EQ(select.text(0), "roughness layer_styles");
    EXPECT_EQ(
        exported.number("SELECT count(*) FROM roughness JOIN rtree_roughness_geom ON fid = id"),
        20);
}

// ---------------------------------------------------------------------------------- FlatGeobuf

/// The features of a file by their segment, as GDAL's own tool reads them. What is not known is
/// left out, as FlatGeobuf does.
std::map<std::string, json> features_by_gdal(const std::filesystem::path& folder,
                                             const std::string& name) {
    const auto out = folder / (name + ".json");
    EXPECT_EQ(output_of(folder,
                        "ogr2ogr -f GeoJSON -lco RFC7946=YES -lco COORDINATE_PRECISION=9 " +
                            out.string() + " " + (folder / name).string()),
              "");
    std::map<std::string, json> features;
    const auto collection = json::parse(content_of(out));
    for (auto feature : collection["features"]) {
        auto& properties = feature["properties"];
        for (auto each = properties.begin(); each != properties.end();) {
            each = each->is_null() ? properties.erase(each) : std::next(each);
        }
        features.emplace(properties["segment"], feature);
    }
    return features;
}

TEST(FlatGeobuf, HoldsWhatTheGeoJsonHolds) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    const auto all = export_segments(store, all_segments(), folder / "out.geojson");
    EXPECT_EQ(export_segments(store, all_segments(), folder / "out.fgb"), all);
    const auto expected = features_by_gdal(folder, "out.geojson");
    const auto found = features_by_gdal(folder, "out.fgb");
    ASSERT_EQ(found.size(), all);
    ASSERT_EQ(expected.size(), all);
    for (const auto& [segment, feature] : expected) {
        ASSERT_TRUE(found.contains(segment));
        EXPECT_EQ(found.at(segment)["properties"], feature["properties"]) << segment;
        const auto& a = found.at(segment)["geometry"]["coordinates"];
        const auto& b = feature["geometry"]["coordinates"];
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_NEAR(a[i][0].get<double>(), b[i][0].get<double>(), 6e-8); // of 7 decimals
            EXPECT_NEAR(a[i][1].get<double>(), b[i][1].get<double>(), 6e-8);
        }
    }
}

TEST(FlatGeobuf, ShowsItsRoughnessAsTypedColumns) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_segments(store, {}, folder / "out.fgb");
    const auto info = output_of(folder, "ogrinfo -ro -so -al " + (folder / "out.fgb").string());
    for (const auto* line : {"Layer name: roughness",
                             "Geometry: Line String",
                             "Feature Count: 20",
                             "GEOGCRS[\"WGS 84\"",
                             "segment: String",
                             "way_id: Integer64",
                             "iri: Real",
                             "passes: Integer",
                             "first_seen: String"}) {
        EXPECT_THAT(info, HasSubstr(line));
    }
}

TEST(FlatGeobuf, HasASpatialIndex) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 1);
    export_segments(store, {}, folder / "out.fgb");
    const auto capabilities =
        output_of(folder,
                  "/usr/bin/python3 -c \"from osgeo import ogr; d = ogr.Open('" +
                      (folder / "out.fgb").string() +
                      "'); print(d.GetLayer(0).TestCapability(ogr.OLCFastSpatialFilter))\"");
    EXPECT_THAT(capabilities, ::testing::AnyOf("1\n", "True\n"));
}

TEST(FlatGeobuf, CanBeEmpty) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    EXPECT_EQ(export_segments(store, {}, folder / "out.fgb"), 0U);
    EXPECT_THAT(output_of(folder, "ogrinfo -ro -so -al " + (folder / "out.fgb").string()),
                HasSubstr("Feature Count: 0"));
}

// ---------------------------------------------------------------------------------------- JSON

TEST(Json, KeepsTheDecimalsItIsGiven) {
    JsonObject object;
    object.add("a", JsonNumber{1.5, 3})
        .add("b", JsonNumber{-0.0001, 2})
        .add("c", json_number(std::nullopt, 1))
        .add("d", json_number(std::nan(""), 1))
        .add("e", std::int64_t{-7})
        .add("f", true)
        .add("g", nullptr);
    EXPECT_EQ(object.text(), R"({"a":1.500,"b":0.00,"c":null,"d":null,"e":-7,"f":true,"g":null})");
}

TEST(Json, EscapesEveryText) {
    for (const std::string text : {"\"\\\n\t\x01", "é€😀", "</script>"}) {
        EXPECT_EQ(json::parse(json_text(text)).get<std::string>(), text);
    }
    EXPECT_EQ(json_text("a\xff"), "\"a\xef\xbf\xbd\""); // not UTF-8: replaced
    EXPECT_EQ(json_string_array({"a", "\""}), R"(["a","\""])");
}

} // namespace
} // namespace macadam
