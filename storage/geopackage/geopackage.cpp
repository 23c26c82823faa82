#include "storage/geopackage/geopackage.hpp"

#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/geopackage/rtree_bulk_load.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {
namespace {

// OGC 12-128r18 (GeoPackage 1.3.1), annex C: table definitions; tables 3 and 20: contents.
constexpr const char* base_tables = R"(
CREATE TABLE gpkg_spatial_ref_sys (
    srs_name TEXT NOT NULL,
    srs_id INTEGER NOT NULL PRIMARY KEY,
    organization TEXT NOT NULL,
    organization_coordsys_id INTEGER NOT NULL,
    definition TEXT NOT NULL,
    description TEXT
);
CREATE TABLE gpkg_contents (
    table_name TEXT NOT NULL PRIMARY KEY,
    data_type TEXT NOT NULL,
    identifier TEXT UNIQUE,
    description TEXT DEFAULT '',
    last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
    min_x DOUBLE,
    min_y DOUBLE,
    max_x DOUBLE,
    max_y DOUBLE,
    srs_id INTEGER,
    CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id)
);
CREATE TABLE gpkg_geometry_columns (
    table_name TEXT NOT NULL,
    column_name TEXT NOT NULL,
    geometry_type_name TEXT NOT NULL,
    srs_id INTEGER NOT NULL,
    z TINYINT NOT NULL,
    m TINYINT NOT NULL,
    CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
    CONSTRAINT uk_gc_table_name UNIQUE (table_name),
    CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
    CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id)
);
CREATE TABLE gpkg_extensions (
    table_name TEXT,
    column_name TEXT,
    extension_name TEXT NOT NULL,
    definition TEXT NOT NULL,
    scope TEXT NOT NULL,
    CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name)
);
INSERT INTO gpkg_spatial_ref_sys VALUES
    ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', 'undefined Cartesian coordinates'),
    ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', 'undefined geographic coordinates'),
    ('WGS 84 geodetic', 4326, 'EPSG', 4326,
     'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AXIS["Latitude",NORTH],AXIS["Longitude",EAST],AUTHORITY["EPSG","4326"]]',
     'longitude/latitude in degrees on the WGS 84 ellipsoid');
)";

// Same source, annex F.3 (R-tree spatial indexes); {0} is the table. The triggers have the wording
// of the specification, which readers recognise.
constexpr const char* index_tables = R"(
CREATE VIRTUAL TABLE rtree_{0}_geom USING rtree(id, minx, maxx, miny, maxy);
INSERT INTO gpkg_extensions VALUES (
    '{0}', 'geom', 'gpkg_rtree_index', 'http://www.geopackage.org/spec131/#extension_rtree',
    'write-only');
)";
constexpr const char* index_triggers = R"(
CREATE TRIGGER rtree_{0}_geom_insert AFTER INSERT ON {0}
    WHEN (new.geom NOT NULL AND NOT ST_IsEmpty(NEW.geom))
BEGIN
    INSERT OR REPLACE INTO rtree_{0}_geom VALUES (
        NEW.fid, ST_MinX(NEW.geom), ST_MaxX(NEW.geom), ST_MinY(NEW.geom), ST_MaxY(NEW.geom));
END;
CREATE TRIGGER rtree_{0}_geom_update1 AFTER UPDATE OF geom ON {0}
    WHEN OLD.fid = NEW.fid AND (NEW.geom NOTNULL AND NOT ST_IsEmpty(NEW.geom))
BEGIN
    INSERT OR REPLACE INTO rtree_{0}_geom VALUES (
        NEW.fid, ST_MinX(NEW.geom), ST_MaxX(NEW.geom), ST_MinY(NEW.geom), ST_MaxY(NEW.geom));
END;
CREATE TRIGGER rtree_{0}_geom_update2 AFTER UPDATE OF geom ON {0}
    WHEN OLD.fid = NEW.fid AND (NEW.geom ISNULL OR ST_IsEmpty(NEW.geom))
BEGIN
    DELETE FROM rtree_{0}_geom WHERE id = OLD.fid;
END;
CREATE TRIGGER rtree_{0}_geom_update3 AFTER UPDATE ON {0}
    WHEN OLD.fid != NEW.fid AND (NEW.geom NOTNULL AND NOT ST_IsEmpty(NEW.geom))
BEGIN
    DELETE FROM rtree_{0}_geom WHERE id = OLD.fid;
    INSERT OR REPLACE INTO rtree_{0}_geom VALUES (
        NEW.fid, ST_MinX(NEW.geom), ST_MaxX(NEW.geom), ST_MinY(NEW.geom), ST_MaxY(NEW.geom));
END;
CREATE TRIGGER rtree_{0}_geom_update4 AFTER UPDATE ON {0}
    WHEN OLD.fid != NEW.fid AND (NEW.geom ISNULL OR ST_IsEmpty(NEW.geom))
BEGIN
    DELETE FROM rtree_{0}_geom WHERE id IN (OLD.fid, NEW.fid);
END;
CREATE TRIGGER rtree_{0}_geom_delete AFTER DELETE ON {0} WHEN old.geom NOT NULL
BEGIN
    DELETE FROM rtree_{0}_geom WHERE id = OLD.fid;
END;
)";
constexpr const char* no_index_triggers = R"(
DROP TRIGGER IF EXISTS rtree_{0}_geom_insert;
DROP TRIGGER IF EXISTS rtree_{0}_geom_update1;
DROP TRIGGER IF EXISTS rtree_{0}_geom_update2;
DROP TRIGGER IF EXISTS rtree_{0}_geom_update3;
DROP TRIGGER IF EXISTS rtree_{0}_geom_update4;
DROP TRIGGER IF EXISTS rtree_{0}_geom_delete;
)";

} // namespace

void make_geopackage(Database& database) {
    database.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                             geopackage_application_id,
                             geopackage_user_version));
    database.run(base_tables);
}

void list_features(Database& database, const FeatureLayer& layer) {
    database
        .prepare(
            "INSERT INTO gpkg_contents (table_name, data_type, identifier, description,"
            " min_x, min_y, max_x, max_y, srs_id) VALUES (?, 'features', ?, ?, ?, ?, ?, ?, 4326)")
        .run(layer.table,
             layer.title,
             layer.description,
             layer.box.west_deg,
             layer.box.south_deg,
             layer.box.east_deg,
             layer.box.north_deg);
    database.prepare("INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, 4326, 0, 0)")
        .run(layer.table, layer.geometry);
}

void add_index_triggers(Database& database, std::string_view table) {
    database.run(fmt::format(fmt::runtime(index_triggers), table));
}

void remove_index_triggers(Database& database, std::string_view table) {
    database.run(fmt::format(fmt::runtime(no_index_triggers), table));
}

void index_features(Database& database, std::string_view table) {
    database.run(fmt::format(fmt::runtime(index_tables), table));
    add_index_triggers(database, table);
    RtreeBulkLoad boxes;
    auto select = database.prepare(fmt::format("SELECT fid, geom FROM {} ORDER BY fid", table));
    while (select.step()) {
        if (const auto box = box_of_geometry(select.blob(1))) {
            boxes.add(select.integer(0), *box);
        }
    }
    std::move(boxes).write_to(database, fmt::format("rtree_{}_geom", table));
}

} // namespace macadam
