#include "hostile_maps.hpp"

#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <array>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

const std::string driver_manager = "MSSQL:server=1;database=a;DRIVER=./legend.png;";

/// A folder of maps that grows.
class Maps {
public:
    explicit Maps(fs::path folder) : folder_{std::move(folder)} { fs::create_directories(folder_); }

    fs::path at(const std::string& name) const { return folder_ / name; }

    /// A map, and what is laid beside one.
    void add(const std::string& name, const std::string& content) {
        lay(name, content);
        files_.push_back(at(name));
    }
    void lay(const std::string& name, const std::string& content) const {
        std::ofstream{at(name), std::ios::binary} << content;
    }
    void add_database(const std::string& name, const std::string& sql) {
        write_database(at(name), sql);
        files_.push_back(at(name));
    }
    void take(const std::string& name) { files_.push_back(at(name)); }

    const std::vector<fs::path>& files() const { return files_; }

private:
    fs::path folder_;
    std::vector<fs::path> files_;
};

std::string vector_vrt(const std::string& source) {
    return fmt::format(
        R"(<OGRVRTDataSource><OGRVRTLayer name="a"><SrcDataSource>{}</SrcDataSource>)"
        R"(<SrcLayer>a</SrcLayer></OGRVRTLayer></OGRVRTDataSource>)",
        source);
}

std::string vrt_of(const std::string& band, const std::string& more = "") {
    return fmt::format(R"(<VRTDataset rasterXSize="4" rasterYSize="4"><SRS>EPSG:3857</SRS>)"
                       R"(<GeoTransform>0,10,0,40,0,-10</GeoTransform>{}{}</VRTDataset>)",
                       more,
                       band);
}

std::string band_of(const std::string& source, const std::string& more = "") {
    return fmt::format(R"(<VRTRasterBand dataType="Byte" band="1"><SimpleSource>)"
                       R"(<SourceFilename relativeToVRT="1">{}</SourceFilename>{})"
                       R"(<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>)",
                       source,
                       more);
}

std::string geojson_in(const std::string& crs) {
    return fmt::format(R"({{"type":"FeatureCollection","crs":{},"features":[{{"type":"Feature",)"
                       R"("properties":{{}},"geometry":{{"type":"LineString","coordinates":)"
                       R"([[15,48],[15.1,48]]}}}}]}})",
                       crs);
}

std::string
gml_of(const std::string& attributes, const std::string& system, const std::string& prolog = "") {
    return fmt::format(
        R"(<?xml version="1.0"?>{}<ogr:FeatureCollection xmlns:gml="http://www.opengis.net/gml" )"
        R"(xmlns:ogr="http://ogr.maptools.org/" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" )"
        R"(xmlns:xlink="http://www.w3.org/1999/xlink" {}>)"
        R"(<gml:featureMember><ogr:a fid="a.0"><ogr:geometryProperty><gml:LineString srsName="{}">)"
        R"(<gml:coordinates>15,48 15.1,48</gml:coordinates></gml:LineString>)"
        R"(</ogr:geometryProperty></ogr:a></gml:featureMember></ogr:FeatureCollection>)",
        prolog,
        attributes,
        system);
}

const std::string degrees =
    R"(GEOGCS["a",DATUM["b",SPHEROID["c",6378137,298.25]],PRIMEM["Greenwich",0],)"
    R"(UNIT["degree",0.0174532925199433],EXTENSION["PROJ4","+proj=longlat +ellps=WGS84 +nadgrids={} +no_defs"]])";

void add_virtual_layers(Maps& maps, const Baits& baits) {
    maps.add("aerial.tif",
             R"(<OGRVRTDataSource><OGRVRTWarpedLayer><OGRVRTLayer name="a"><SrcDataSource>)" +
                 driver_manager +
                 R"(</SrcDataSource><SrcLayer>a</SrcLayer></OGRVRTLayer><TargetSRS>EPSG:4326)"
                 R"(</TargetSRS></OGRVRTWarpedLayer></OGRVRTDataSource>)");
    maps.add("layer.vrt", vector_vrt(driver_manager));
    maps.add("late.geojson", std::string(1500, ' ') + vector_vrt(driver_manager));
    maps.add("union.gml", "<!-- opengis.net/gml -->" + vector_vrt(driver_manager));
    maps.add("wfs.xml", "<OGRWFSDataSource><URL>" + baits.url + "</URL></OGRWFSDataSource>");
    maps.add("wms.xml",
             "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + baits.url +
                 "/${z}/${x}/${y}.png</ServerUrl></Service></GDAL_WMS>");
}

void add_databases(Maps& maps, const Baits& baits) {
    const auto geopackage = [](const std::string& more) {
        return "PRAGMA application_id = 1196444487; PRAGMA user_version = 10300;"
               "CREATE TABLE gpkg_spatial_ref_sys(srs_name, srs_id INTEGER PRIMARY KEY, "
               "organization, organization_coordsys_id, definition, description);"
               "INSERT INTO gpkg_spatial_ref_sys VALUES('a', 4326, 'EPSG', 4326, 'a', NULL);"
               "CREATE TABLE gpkg_contents(table_name PRIMARY KEY, data_type, identifier, "
               "description, last_change, min_x, min_y, max_x, max_y, srs_id);"
               "INSERT INTO gpkg_contents VALUES('t', 'features', 't', '', '', 0, 0, 1, 1, 4326);"
               "CREATE TABLE gpkg_geometry_columns(table_name, column_name, geometry_type_name, "
               "srs_id, z, m);"
               "INSERT INTO gpkg_geometry_columns VALUES('t', 'geom', 'LINESTRING', 4326, 0, 0);" +
               more;
    };
    const auto virtual_ogr = [](const std::string& source) {
        return sql_of_virtual_table("CREATE VIRTUAL TABLE t USING VirtualOGR(''" + source +
                                    "'',0,''a'')");
    };
    maps.add_database("roads.sqlite", virtual_ogr(driver_manager));
    maps.add_database("roads_wfs.sqlite", virtual_ogr("WFS:" + baits.url));
    maps.add_database("roads.gpkg", geopackage(virtual_ogr(driver_manager)));
    maps.add_database("text.sqlite",
                      sql_of_virtual_table("CREATE VIRTUAL TABLE t USING VirtualText(''" +
                                           baits.file.string() + "'',''UTF-8'',0)"));
    maps.add_database("comment.gpkg",
                      geopackage(sql_of_virtual_table(
                          "create/**/virtual table t using/* using rtree(a) */VirtualOGR(''" +
                          driver_manager + "'',0,''a'')")));
    maps.add_database("name.sqlite",
                      sql_of_virtual_table("CREATE VIRTUAL TABLE \"t USING rtree(a)\" USING "
                                           "VirtualOGR(''" +
                                           driver_manager + "'',0,''a'')"));
    maps.add_database("extension.gpkg",
                      geopackage("CREATE VIEW t AS SELECT 1 AS fid, "
                                 "load_extension('./legend.png') AS geom;"));
    maps.add_database("geocode.sqlite",
                      "CREATE TABLE a(b); CREATE VIEW t AS SELECT ogr_geocode('a', '" + baits.url +
                          "') AS geometry FROM a;");
    maps.add_database("endless.gpkg",
                      geopackage("CREATE VIEW t AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL "
                                 "SELECT x + 1 FROM c) SELECT x AS fid, NULL AS geom FROM c;"));
    maps.add_database(
        "column.gpkg",
        geopackage("CREATE TABLE t(fid INTEGER PRIMARY KEY, geom BLOB, a TEXT);"
                   "INSERT INTO t(geom) VALUES(NULL); PRAGMA writable_schema = ON;"
                   "UPDATE sqlite_master SET sql = 'CREATE TABLE t(fid INTEGER PRIMARY KEY, geom "
                   "BLOB, a TEXT AS (load_extension(''./legend.png'')))' WHERE name = 't';"));
    const std::string metadata =
        "CREATE TABLE metadata(name, value); INSERT INTO metadata VALUES('format', 'png'), "
        "('minzoom', '0'), ('maxzoom', '0'), ('bounds', '-180,-85,180,85');";
    maps.add_database("endless.mbtiles",
                      metadata + "CREATE VIEW tiles AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL "
                                 "SELECT x + 1 FROM c) SELECT x + 9 AS zoom_level, 0 AS "
                                 "tile_column, 0 AS tile_row, x'00' AS tile_data FROM c;");
    maps.add_database("driver.mbtiles",
                      metadata +
                          "CREATE TABLE tiles(zoom_level, tile_column, tile_row, tile_data);"
                          "INSERT INTO tiles VALUES(0, 0, 0, CAST('" +
                          vrt_of(band_of(baits.file.string())) + "' AS BLOB));" +
                          virtual_ogr(driver_manager));
}

void add_virtual_rasters(Maps& maps, const Baits& baits) {
    const auto file = baits.file.string();
    maps.add("raw.vrt",
             vrt_of(R"(<VRTRasterBand dataType="Byte" band="1" subClass="VRTRawRasterBand">)"
                    R"(<SourceFilename relativeToVRT="0">)" +
                    file + "</SourceFilename></VRTRasterBand>"));
    maps.add(
        "raw_element.vrt",
        vrt_of(R"(<VRTRasterBand dataType="Byte" band="1"><subClass>VRTRawRasterBand</subClass>)"
               R"(<SourceFilename relativeToVRT="0">)" +
               file + "</SourceFilename></VRTRasterBand>"));
    maps.add("python.vrt",
             vrt_of(R"(<VRTRasterBand dataType="Byte" band="1" subClass="VRTDerivedRasterBand">)"
                    R"(<PixelFunctionLanguage>Python</PixelFunctionLanguage><PixelFunctionType>)"
                    R"(os.system</PixelFunctionType></VRTRasterBand>)"));
    maps.add("far.vrt", vrt_of(band_of("/vsicurl/" + baits.url)));
    maps.add("elsewhere.vrt", vrt_of(band_of(file)));
    maps.add("up.vrt", vrt_of(band_of("../../" + file)));
    maps.add("link.vrt", vrt_of(band_of("link.tif")));
    fs::create_symlink(file, maps.at("link.tif"));
    maps.add("options.vrt",
             vrt_of(band_of("whole.tif", "<OpenOptions><OOI key=\"A\">b</OOI></OpenOptions>")));
    maps.add("itself.vrt", vrt_of(band_of("itself.vrt")));
    maps.add("attribute.vrt",
             vrt_of(R"(<VRTRasterBand dataType="Byte" band="1"><SimpleSource SourceFilename=")" +
                    file + R"("/></VRTRasterBand>)"));
    maps.add("layer_source.vrt", vrt_of(band_of("layer.vrt")));
    maps.add("memory.vrt", vrt_of(band_of("MEM:::DATAPOINTER=1,PIXELS=4,LINES=4")));
    maps.add("directory.vrt", vrt_of(band_of("GTIFF_DIR:1:" + file)));
    maps.add("database.vrt", vrt_of(band_of("roads.gpkg")));
    maps.add("warped.vrt",
             R"(<VRTDataset rasterXSize="4" rasterYSize="4" subClass="VRTWarpedDataset">)"
             R"(<GDALWarpOptions><SourceDataset>)" +
                 file + "</SourceDataset></GDALWarpOptions></VRTDataset>");
    maps.add("system.vrt",
             fmt::format(R"(<VRTDataset rasterXSize="4" rasterYSize="4"><SRS>{}</SRS>)"
                         R"(<GeoTransform>0,10,0,40,0,-10</GeoTransform>{}</VRTDataset>)",
                         file,
                         band_of("whole.tif")));
    maps.add("entity.vrt",
             "<!DOCTYPE VRTDataset [<!ENTITY a SYSTEM \"" + file + "\">]>" +
                 vrt_of(band_of("&a;")));
}

void add_texts(Maps& maps, const Baits& baits) {
    const auto file = baits.file.string();
    maps.add("crs_link.geojson",
             geojson_in(R"({"type":"link","properties":{"href":")" + baits.url + R"("}})"));
    for (const auto& [name, system] :
         {std::pair{"crs_url.geojson", baits.url}, {"crs_file.geojson", file}}) {
        maps.add(name, geojson_in(R"({"type":"name","properties":{"name":")" + system + R"("}})"));
    }
    const auto schema = [](const std::string& place) {
        return R"(xsi:schemaLocation="http://ogr.maptools.org/ )" + place + "\"";
    };
    maps.add("schema_url.gml", gml_of(schema(baits.url + "/a.xsd"), "EPSG:4326"));
    maps.add("schema_file.gml", gml_of(schema(file), "EPSG:4326"));
    maps.add("system_url.gml", gml_of("", baits.url));
    maps.add("system_file.gml", gml_of("", file));
    maps.add("entity.gml",
             gml_of("", "EPSG:4326", "<!DOCTYPE a SYSTEM \"" + baits.url + "/a.dtd\">"));
    maps.add("link.kml",
             "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><NetworkLink><Link><href>" +
                 baits.url + "</href></Link></NetworkLink><Placemark><styleUrl>" + baits.url +
                 "#a</styleUrl><LineString><coordinates>15,48 15.1,48</coordinates></LineString>"
                 "</Placemark></Document></kml>");
    maps.add("seamless.tab",
             "!table\n!version 300\n!charset Neutral\n\nDefinition Table\n  Type NATIVE Charset "
             "\"Neutral\"\n  Fields 1\n    Table Char (100) ;\nbegin_metadata\n\"\\IsSeamless\" = "
             "\"TRUE\"\nend_metadata\n");
    maps.add("view.tab",
             "!table\n!version 300\n\nOpen Table \"" + file +
                 "\" Hide\n\nCreate View a As\nSelect "
                 "*\nFrom a, b\n");
    maps.add("science.nc", "CDF\x01" + std::string(60, '\0'));
    maps.add("science.h5", "\x89HDF\r\n\x1a\n" + std::string(60, '\0'));
    maps.add("packed.zip", "PK\x03\x04" + std::string(60, '\0'));
    maps.add("server.json",
             R"({"type":"STACTA","stac_version":"1.0","href":")" + baits.url + "\"}");
    maps.add("grid.geojson",
             geojson_in(R"({"type":"name","properties":{"name":")" +
                        std::regex_replace(
                            fmt::format(fmt::runtime(degrees), file), std::regex{"\""}, "\\\"") +
                        R"("}})"));
}

/// Whole maps with something hostile beside them.
void add_company(Maps& maps, const Baits& baits) {
    const auto folder = maps.at(".");
    const auto file = baits.file.string();
    maps.lay("plain.geojson", geojson_in("null"));
    for (const auto* const name : {"beside.shp", "table.shp"}) {
        EXPECT_EQ(output_of(folder,
                            fmt::format("ogr2ogr -f 'ESRI Shapefile' {} {}",
                                        maps.at(name).string(),
                                        maps.at("plain.geojson").string())),
                  "");
        maps.take(name);
    }
    maps.lay("beside.prj", fmt::format(fmt::runtime(degrees), file));
    fs::remove(maps.at("table.dbf"));
    fs::create_symlink(file, maps.at("table.dbf"));
    const std::array companions{
        std::pair{"whole.tif", std::string{}},
        std::pair{"overview.tif.ovr", vrt_of(band_of(file))},
        std::pair{"mask.tif.msk", vector_vrt(driver_manager)},
        std::pair{"aux.tif.aux.xml",
                  "<PAMDataset><SRS>" + file +
                      "</SRS><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" + file +
                      "</MDI></Metadata></PAMDataset>"},
        std::pair{"far.tif.aux.xml",
                  "<PAMDataset><SRS>" + baits.url +
                      "</SRS><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">/vsicurl/" +
                      baits.url + "</MDI></Metadata></PAMDataset>"}};
    for (const auto& [name, content] : companions) {
        const auto tif = std::string{name}.substr(0, std::string{name}.find(".tif") + 4);
        EXPECT_EQ(output_of(folder,
                            "gdal_create -q -outsize 4 4 -bands 1 -a_srs EPSG:3857 -a_ullr 0 40 40 "
                            "0 " +
                                maps.at(tif).string()),
                  "");
        maps.take(tif);
        if (tif != name) {
            maps.lay(name, content);
        }
    }
}

/// The short names of all drivers that GDAL's own programs know.
std::set<std::string> driver_names(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto* const program : {"gdalinfo", "ogrinfo"}) {
        std::istringstream lines{output_of(folder, std::string{program} + " --formats")};
        for (std::string line; std::getline(lines, line);) {
            if (const auto end = line.find(" -"); line.starts_with("  ") && end != line.npos) {
                names.insert(line.substr(2, end - 2));
            }
        }
    }
    EXPECT_GT(names.size(), 100U);
    // What they want to stand before the colon, where that is not their name.
    names.insert({"PG",
                  "MYSQL",
                  "OCI",
                  "MSSQL",
                  "PGEO",
                  "WFS3",
                  "OAPIF",
                  "GTIFF_DIR",
                  "NETCDF",
                  "HDF5",
                  "HDF4_SDS",
                  "JPEG_SUBFILE",
                  "CSW",
                  "ES",
                  "GMLAS",
                  "CARTO",
                  "AMIGOCLOUD"});
    return names;
}

} // namespace

void write_database(const fs::path& file, const std::string& sql) {
    fs::remove(file);
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << file << ": " << sqlite3_errmsg(database);
    sqlite3_close(database);
}

std::string sql_of_virtual_table(const std::string& definition) {
    return "CREATE TABLE x(a); PRAGMA writable_schema = ON;"
           "INSERT INTO sqlite_master(type, name, tbl_name, rootpage, sql) VALUES('table', '" +
           std::string{definition.find("\"t USING") != std::string::npos ? "t USING rtree(a)"
                                                                         : "t"} +
           "', 't', 0, '" + definition + "');";
}

std::vector<fs::path>
write_hostile_maps(const fs::path& folder, const Baits& baits, const fs::path& library) {
    Maps maps{folder};
    fs::copy_file(library, maps.at("legend.png"), fs::copy_options::overwrite_existing);
    maps.take("legend.png");
    add_company(maps, baits);
    add_virtual_layers(maps, baits);
    add_databases(maps, baits);
    add_virtual_rasters(maps, baits);
    add_texts(maps, baits);
    return maps.files();
}

std::vector<std::string> connection_strings(const fs::path& folder, const Baits& baits) {
    std::vector<std::string> strings;
    for (const auto& name : driver_names(folder)) {
        strings.push_back(name + ":" + baits.url + ";DRIVER=./legend.png;");
        strings.push_back(name + ":" + baits.file.string());
    }
    return strings;
}

std::vector<fs::path> write_generated_maps(const fs::path& folder, const Baits& baits) {
    Maps maps{folder};
    int number = 0;
    for (const auto& source : connection_strings(folder, baits)) {
        const auto name = fmt::format("{:03}", ++number);
        maps.add(name + ".geojson", vector_vrt(source));
        maps.add(name + ".vrt", vrt_of(band_of(source)));
        maps.add(name + ".tif", source);
        if (number % 2 == 1) { // a database for each driver: they take long to write
            maps.add_database(name + ".sqlite",
                              sql_of_virtual_table("CREATE VIRTUAL TABLE t USING VirtualOGR(''" +
                                                   source + "'',0,''a'')"));
        }
    }
    return maps.files();
}

} // namespace macadam::testing
