#include "storage/store/server/server_schema.hpp"

#include "estimator/common/error.hpp"
#include "storage/jobs/job_schema.hpp"
#include "storage/store/server/server_tables.hpp"
#include "storage/styles/road_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

namespace macadam {
namespace {

/// Text as an SQL literal; of our own constants, which hold no backslashes.
std::string literal(std::string_view text) {
    std::string quoted = "'";
    for (const char c : text) {
        quoted += c == '\'' ? "''" : std::string(1, c);
    }
    return quoted + "'";
}

constexpr const char* migration_table = R"(
CREATE SCHEMA macadam;
COMMENT ON SCHEMA macadam IS 'Road roughness maps: passes of cars and fused values of road segments';
CREATE TABLE macadam.migration (
    number integer PRIMARY KEY,
    what text NOT NULL,
    at timestamptz NOT NULL DEFAULT now()
);
COMMENT ON TABLE macadam.migration IS 'Steps by which this schema was made, in order';
COMMENT ON COLUMN macadam.migration.number IS 'Number of the step, from 1';
COMMENT ON COLUMN macadam.migration.what IS 'What it did';
COMMENT ON COLUMN macadam.migration.at IS 'When it ran';
INSERT INTO macadam.migration VALUES (1, 'tables, views, roles');
)";

std::string table_sql(const ServerTable& table, const std::string& postgis) {
    std::string columns;
    std::string comments =
        fmt::format("COMMENT ON TABLE macadam.{} IS {};\n", table.name, literal(table.meaning));
    for (const auto& column : table.columns) {
        std::string type = column.type;
        if (const auto at = type.find("{postgis}"); at != std::string::npos) {
            type.replace(at, std::string_view{"{postgis}"}.size(), postgis);
        }
        columns += fmt::format("    {} {},\n", column.name, type);
        comments += fmt::format("COMMENT ON COLUMN macadam.{}.{} IS {};\n",
                                table.name,
                                column.name,
                                literal(column.meaning));
    }
    const auto partition = table.partition_by != nullptr
                               ? fmt::format(" PARTITION BY LIST ({})", table.partition_by)
                               : std::string{};
    return fmt::format("CREATE TABLE macadam.{} (\n{}    {}\n){};\n{}",
                       table.name,
                       columns,
                       table.constraints,
                       partition,
                       comments);
}

constexpr const char* indexes = R"(
CREATE INDEX segment_geom ON macadam.segment USING gist (geom);
CREATE UNIQUE INDEX segment_key ON macadam.segment (cell, way_id, direction, seq);
CREATE INDEX drive_of_trip ON macadam.drive (trip);
CREATE INDEX event_of_trip ON macadam.event (trip);
CREATE INDEX way_name ON macadam.way (name);
CREATE INDEX chunk_dirty_since ON macadam.chunk_dirty (since_ms, chunk);
COMMENT ON INDEX macadam.segment_geom IS 'Segments by place';
COMMENT ON INDEX macadam.segment_key IS 'Segments by key';
COMMENT ON INDEX macadam.drive_of_trip IS 'Drives of a trip, to forget it';
COMMENT ON INDEX macadam.event_of_trip IS 'Defects of a trip, to forget it';
COMMENT ON INDEX macadam.way_name IS 'Roads by name';
COMMENT ON INDEX macadam.chunk_dirty_since IS 'Chunks to be fused, oldest first';
)";

// The same as drive_body.cpp reads. Differences wrap around there; in sound passes none does.
constexpr const char* unpacking = R"(
CREATE FUNCTION macadam.passes_in(body bytea) RETURNS TABLE (
    "offset" integer, occurrence bigint, iri_left_um integer, iri_right_um integer,
    iri_centre_um integer, iri_um integer, sd_um integer, centre_only boolean, validity integer,
    speed_mmps integer, covered_mm integer, confidence_ppm integer, t_ms bigint)
LANGUAGE plpgsql IMMUTABLE STRICT PARALLEL SAFE SET search_path = pg_catalog AS $$
DECLARE
    at integer := 1;
    size integer := length(body);
    flags integer;
    field integer;
    number bigint;
    shift integer;
    part integer;
    last bigint[] := array_fill(0::bigint, ARRAY[9]); -- left, right, centre, iri, sd, speed, ...
BEGIN
    IF size = 0 OR get_byte(body, 0) <> 1 THEN
        RAISE EXCEPTION 'unknown format of packed passes';
    END IF;
    "offset" := 0;
    WHILE at < size LOOP
        FOR field IN -3..9 LOOP
            IF field IN (-1, 0) THEN -- flags, validity
                IF field = -1 THEN flags := get_byte(body, at);
                ELSE validity := get_byte(body, at);
                END IF;
                at := at + 1;
                CONTINUE;
            END IF;
            CONTINUE WHEN field BETWEEN 1 AND 3 AND (flags >> (field - 1)) & 1 = 0;
            number := 0;
            shift := 0;
            LOOP
                part := get_byte(body, at);
                at := at + 1;
                number := number | ((part & 127)::bigint << shift);
                shift := shift + 7;
                EXIT WHEN part < 128;
            END LOOP;
            IF field = -3 THEN
                "offset" := "offset" + number;
            ELSIF field = -2 THEN
                occurrence := number;
            ELSE
                IF field = 4 AND flags & 3 = 3 THEN
                    last[4] := (last[1] + last[2]) / 2;
                END IF;
                last[field] := last[field] + ((number >> 1) # (-(number & 1)));
            END IF;
        END LOOP;
        iri_left_um := CASE WHEN flags & 1 = 1 THEN last[1] END;
        iri_right_um := CASE WHEN flags & 2 = 2 THEN last[2] END;
        iri_centre_um := CASE WHEN flags & 4 = 4 THEN last[3] END;
        iri_um := last[4];
        sd_um := last[5];
        centre_only := flags & 8 = 8;
        speed_mmps := last[6];
        covered_mm := last[7];
        confidence_ppm := last[8];
        t_ms := last[9];
        RETURN NEXT;
    END LOOP;
END $$;
COMMENT ON FUNCTION macadam.passes_in(bytea) IS
    'Unpacks the passes of a drive; offset is the number of the segment in its chunk';

CREATE VIEW macadam.pass AS
    SELECT drive.cell, drive.chunk + unpacked."offset" AS segment, drive.trip, unpacked.occurrence,
           unpacked.iri_left_um, unpacked.iri_right_um, unpacked.iri_centre_um, unpacked.iri_um,
           unpacked.sd_um, unpacked.centre_only, unpacked.validity, unpacked.speed_mmps,
           unpacked.covered_mm, unpacked.confidence_ppm, unpacked.t_ms,
           nullif(drive.drive, -1) AS drive
    FROM macadam.drive CROSS JOIN LATERAL macadam.passes_in(drive.body) AS unpacked;
COMMENT ON VIEW macadam.pass IS
    'Passes of trips over segments, unpacked: iri in um/m, speed in mm/s, covered in mm, confidence in ppm, t in ms since the start of the trip';
)";

constexpr const char* roughness_view = R"(
CREATE VIEW macadam.roughness AS
    SELECT segment.fid, segment.geom, segment.segment, segment.way_id, way.name, way.highway,
           segment.direction, segment.from_m, segment.to_m,
           state.iri_um / 1000.0::double precision AS iri,
           state.sd_um / 1000.0::double precision AS iri_sd,
           state.low_um / 1000.0::double precision AS iri_low,
           state.high_um / 1000.0::double precision AS iri_high,
           state.left_um / 1000.0::double precision AS iri_left,
           state.right_um / 1000.0::double precision AS iri_right,
           CASE WHEN state.centre_only THEN 'HRI>MRI' ELSE 'MRI' END AS "index",
           state.class, state.passes, state.vehicles,
           (to_timestamp(state.first_seen_ms / 1000.0) AT TIME ZONE 'UTC')::date AS first_seen,
           (to_timestamp(state.last_seen_ms / 1000.0) AT TIME ZONE 'UTC')::date AS last_seen,
           state.trend_um_per_year / 1000.0::double precision AS trend_per_year,
           state.trend_sd_um_per_year / 1000.0::double precision AS trend_sd,
           (to_timestamp(state.changed_ms / 1000.0) AT TIME ZONE 'UTC')::date AS changed,
           state.change_um / 1000.0::double precision AS change,
           state.validity
    FROM macadam.segment_state AS state
    JOIN macadam.segment ON segment.cell = state.cell AND segment.fid = state.fid
    JOIN macadam.way ON way.way_id = segment.way_id;
COMMENT ON VIEW macadam.roughness IS
    'Roughness (IRI, mm/m) of the segments driven; QGIS shows it with its style';
)";

constexpr const char* cells = R"(
CREATE FUNCTION macadam.add_cell(cell integer) RETURNS void
LANGUAGE plpgsql SET search_path = pg_catalog AS $$
DECLARE
    parent text;
BEGIN
    FOREACH parent IN ARRAY ARRAY['segment', 'drive', 'segment_state'] LOOP
        EXECUTE format('CREATE TABLE macadam.%I PARTITION OF macadam.%I FOR VALUES IN (%s)',
                       parent || '_' || cell, parent, cell);
        EXECUTE format('COMMENT ON TABLE macadam.%I IS %L', parent || '_' || cell,
                       'Rows of table ' || parent || ' in map tile ' || cell);
    END LOOP;
END $$;
COMMENT ON FUNCTION macadam.add_cell(integer) IS 'Creates the partitions of a map tile';
)";

// Roles belong to the whole server. Who may not create them grants rights to others himself.
constexpr const char* roles = R"(
DO $$
DECLARE
    role text;
BEGIN
    FOREACH role IN ARRAY ARRAY['macadam_reader', 'macadam_importer', 'macadam_operator'] LOOP
        IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = role) THEN
            IF (SELECT rolcreaterole OR rolsuper FROM pg_roles WHERE rolname = current_user) THEN
                EXECUTE format('CREATE ROLE %I NOLOGIN', role);
            ELSE
                CONTINUE;
            END IF;
        END IF;
        EXECUTE format('GRANT USAGE ON SCHEMA macadam TO %I', role);
        EXECUTE format('GRANT SELECT ON {0} TO %I', role);
        IF role <> 'macadam_reader' THEN
            EXECUTE format('GRANT SELECT ON ALL TABLES IN SCHEMA macadam TO %I', role);
            EXECUTE format('GRANT INSERT, UPDATE, DELETE ON {1} TO %I', role);
            EXECUTE format('GRANT USAGE ON ALL SEQUENCES IN SCHEMA macadam TO %I', role);
        END IF;
        IF role = 'macadam_operator' THEN
            EXECUTE format('GRANT INSERT, UPDATE, DELETE ON ALL TABLES IN SCHEMA macadam TO %I', role);
            EXECUTE format('GRANT UPDATE ON ALL SEQUENCES IN SCHEMA macadam TO %I', role);
            EXECUTE format('REVOKE INSERT, UPDATE, DELETE ON macadam.migration FROM %I', role);
        END IF;
    END LOOP;
END $$;
REVOKE ALL ON FUNCTION macadam.add_cell(integer) FROM PUBLIC;
)";

/// What an importer writes: trips, and the values fused from them.
constexpr const char* written_by_importers =
    "macadam.vehicle, macadam.trip, macadam.row_reason, macadam.drive, macadam.event,"
    " macadam.event_search, macadam.segment_state, macadam.chunk_state,"
    " macadam.chunk_dirty, macadam.import_note, macadam.audit, macadam.state_change";

std::string read_by_all() {
    std::string names = "macadam.migration, macadam.roughness";
    for (const auto& table : server_tables()) {
        if (table.use == ServerUse::road) {
            names += fmt::format(", macadam.{}", table.name);
        }
    }
    return names;
}

/// Step after migration 1.
struct Migration {
    int number;
    const char* what;
    const char* sql;
};

/// A new database has the column from its table's definition.
constexpr const char* trimmed_lengths = R"(
ALTER TABLE macadam.trip ADD COLUMN IF NOT EXISTS trimmed_mm bigint NOT NULL DEFAULT 0;
COMMENT ON COLUMN macadam.trip.trimmed_mm IS 'Left out at ends and long stops by the recorder, mm';
)";

const std::array migrations{Migration{2, "queue for workers", job_schema},
                            Migration{3, "lengths that recorders trimmed", trimmed_lengths}};

void run_migrations_after(int version, ServerConnection& server) {
    for (const auto& [number, what, sql] : migrations) {
        if (number > version) {
            server.run(sql);
            server.rows("INSERT INTO macadam.migration VALUES ($1, $2)",
                        {std::to_string(number), what});
        }
    }
}

bool has_schema(ServerConnection& server) {
    return server.number("SELECT count(*) FROM pg_namespace WHERE nspname = 'macadam'") != 0;
}

/// Schema in which PostGIS is installed, quoted.
std::string postgis_schema(ServerConnection& server) {
    const auto found = server.rows("SELECT quote_ident(nspname) FROM pg_extension"
                                   " JOIN pg_namespace AS n ON n.oid = extnamespace"
                                   " WHERE extname = 'postgis'");
    if (found.size() != 1 || !found[0][0]) {
        throw InputError{fmt::format("{}: has no PostGIS; an administrator of the server adds it "
                                     "with 'CREATE EXTENSION postgis'",
                                     server.address())};
    }
    return *found[0][0];
}

/// Version of the schema, not newer than this program.
int version_of(ServerConnection& server) {
    if (!has_schema(server)) {
        throw InputError{fmt::format("{0}: has no road database: 'macadam copy roads.gpkg {0}' "
                                     "makes one",
                                     server.address())};
    }
    const auto version = server.number("SELECT coalesce(max(number), 0) FROM macadam.migration");
    if (version > server_schema_version) {
        throw InputError{fmt::format("{}: its schema is of version {}, expected {}: it was made by "
                                     "a newer version of Macadam",
                                     server.address(),
                                     version,
                                     server_schema_version)};
    }
    return static_cast<int>(version);
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
    return text;
}

} // namespace

void create_server_schema(ServerConnection& server) {
    if (has_schema(server)) {
        throw InputError{fmt::format("{}: already has a schema macadam, expected a database "
                                     "without one",
                                     server.address())};
    }
    const auto postgis = postgis_schema(server);
    server.run(migration_table);
    for (const auto& table : server_tables()) {
        server.run(table_sql(table, postgis));
    }
    server.run(indexes);
    server.run(unpacking);
    server.run(roughness_view);
    server.run(cells);
    server.run(replaced(replaced(roles, "{0}", read_by_all()), "{1}", written_by_importers));
    run_migrations_after(1, server);
}

void add_server_cells(ServerConnection& server, const std::set<std::int32_t>& numbers) {
    for (const auto cell : numbers) {
        server.rows("SELECT macadam.add_cell($1)", {std::to_string(cell)});
    }
}

void add_server_style(ServerConnection& server, const ClassTable& classes) {
    const RoadStyle style{classes};
    server.run("SAVEPOINT style");
    try {
        // As QGIS creates it.
        server.run("CREATE TABLE IF NOT EXISTS public.layer_styles (id serial PRIMARY KEY,"
                   " f_table_catalog varchar, f_table_schema varchar, f_table_name varchar,"
                   " f_geometry_column varchar, stylename text, styleqml xml, stylesld xml,"
                   " useasdefault boolean, description text, owner varchar(63), ui xml,"
                   " update_time timestamp DEFAULT CURRENT_TIMESTAMP, type varchar)");
        server.run("DELETE FROM public.layer_styles WHERE f_table_schema = 'macadam'"
                   " AND f_table_name = 'roughness'");
        server.rows("INSERT INTO public.layer_styles (f_table_catalog, f_table_schema,"
                    " f_table_name, f_geometry_column, stylename, styleqml, stylesld,"
                    " useasdefault, description, owner) VALUES (current_database(), 'macadam',"
                    " 'roughness', 'geom', 'roughness', XMLPARSE(DOCUMENT $1),"
                    " XMLPARSE(DOCUMENT $2), true, $3, current_user)",
                    {qml_style(style), sld_style(style, "roughness"), std::string{classes.title}});
        server.run("GRANT SELECT ON public.layer_styles TO PUBLIC");
    } catch (const InputError&) {
        server.run("ROLLBACK TO SAVEPOINT style"); // the view serves without a style
    }
    server.run("RELEASE SAVEPOINT style");
}

void expect_server_schema(ServerConnection& server) {
    if (const auto version = version_of(server); version < server_schema_version) {
        throw InputError{fmt::format("{0}: its schema is of version {1}, expected {2}: 'macadam "
                                     "upgrade {0}' brings it there",
                                     server.address(),
                                     version,
                                     server_schema_version)};
    }
}

int upgrade_server_schema(ServerConnection& server) {
    server.begin(false);
    static_cast<void>(version_of(server)); // says what is missing
    server.run("LOCK TABLE macadam.migration IN SHARE ROW EXCLUSIVE MODE");
    const auto version = version_of(server);
    run_migrations_after(version, server);
    server.commit();
    return version;
}

std::int32_t cell_of(const GeoPoint& first_node) {
    constexpr int zoom = 8;
    constexpr double tiles = 1 << zoom;
    constexpr double radians = std::numbers::pi / 180;
    const auto tile = [](double share) {
        return static_cast<std::uint32_t>(std::clamp(share * tiles, 0.0, tiles - 1));
    };
    const auto x = tile((first_node.lon_deg + 180) / 360);
    const auto y =
        tile((1 - std::asinh(std::tan(first_node.lat_deg * radians)) / std::numbers::pi) / 2);
    std::uint32_t cell = 0;
    for (int bit = zoom - 1; bit >= 0; --bit) {
        cell = cell << 2 | (y >> bit & 1) << 1 | (x >> bit & 1);
    }
    return static_cast<std::int32_t>(cell);
}

} // namespace macadam
