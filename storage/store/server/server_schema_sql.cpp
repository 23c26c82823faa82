#include "storage/store/server/server_schema_sql.hpp"

#include "storage/postgres/role_grants.hpp"

namespace macadam {

const char* const schema_begin_sql = R"(
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

const char* const schema_indexes_sql = R"(
CREATE INDEX segment_geom ON macadam.segment USING gist (geom);
CREATE UNIQUE INDEX segment_key ON macadam.segment (cell, way_id, direction, seq);
CREATE INDEX drive_of_trip ON macadam.drive (trip);
CREATE INDEX event_of_trip ON macadam.event (trip);
CREATE INDEX way_name ON macadam.way (name);
COMMENT ON INDEX macadam.segment_geom IS 'Segments by place';
COMMENT ON INDEX macadam.segment_key IS 'Segments by key';
COMMENT ON INDEX macadam.drive_of_trip IS 'Drives of a trip, to forget it';
COMMENT ON INDEX macadam.event_of_trip IS 'Defects of a trip, to forget it';
COMMENT ON INDEX macadam.way_name IS 'Roads by name';
)";

// The same as drive_body.cpp reads. Differences wrap around there; in sound passes none does.
const char* const schema_unpacking_sql = R"(
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

const char* const schema_roughness_sql = R"(
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

const char* const schema_cells_sql = R"(
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
const char* const schema_roles_sql = R"(
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

namespace {

// A reader remembers the snapshot in which it copied: what that did not see has changed since.
constexpr const char* changes = R"(
CREATE TABLE macadam.chunk_change (
    chunk bigint PRIMARY KEY,
    changed xid8 NOT NULL DEFAULT pg_current_xact_id()
);
CREATE INDEX chunk_change_changed ON macadam.chunk_change (changed);
COMMENT ON TABLE macadam.chunk_change IS 'Chunks that were fused, for those who keep copies: what a snapshot did not see';
COMMENT ON COLUMN macadam.chunk_change.chunk IS 'Row of the first segment';
COMMENT ON COLUMN macadam.chunk_change.changed IS 'Transaction that fused it last';
COMMENT ON INDEX macadam.chunk_change_changed IS 'Chunks by the transaction that fused them';
ALTER TABLE macadam.trip ADD COLUMN changed xid8 NOT NULL DEFAULT pg_current_xact_id();
CREATE INDEX trip_changed ON macadam.trip (changed);
COMMENT ON COLUMN macadam.trip.changed IS 'Transaction that stored it';
COMMENT ON INDEX macadam.trip_changed IS 'Trips by the transaction that stored them';
INSERT INTO macadam.meta VALUES ('store_rows', gen_random_uuid()::text) ON CONFLICT (key) DO NOTHING;
)";

} // namespace

std::string changes_migration_sql() {
    return changes +
           granting("SELECT ON macadam.chunk_change, macadam.chunk_dirty",
                    {"macadam_reader", "macadam_importer", "macadam_operator"}) +
           granting("INSERT, UPDATE, DELETE ON macadam.chunk_change",
                    {"macadam_importer", "macadam_operator"});
}

// A new database has the column from its table's definition.
const char* const marks_migration_sql = R"(
-- Queues, whose rows go soon: their dead rows must not wait for a share of a large table.
ALTER TABLE macadam.chunk_dirty SET (autovacuum_vacuum_scale_factor = 0, autovacuum_vacuum_threshold = 20000);
ALTER TABLE macadam.job SET (autovacuum_vacuum_scale_factor = 0.01, autovacuum_analyze_scale_factor = 0.01);
ALTER TABLE macadam.drive DROP CONSTRAINT IF EXISTS drive_trip_fkey;
COMMENT ON COLUMN macadam.drive.trip IS 'Trip; comes and goes with it in one transaction, so that a foreign key, which costs as much as the row itself, would guard nothing';
DO $$
BEGIN
    IF EXISTS (SELECT FROM pg_attribute WHERE attrelid = 'macadam.chunk_dirty'::regclass AND attname = 'marks') THEN
        ALTER TABLE macadam.chunk_dirty RENAME COLUMN marks TO trip;
        UPDATE macadam.chunk_dirty SET trip = 0;
        ALTER TABLE macadam.chunk_dirty ALTER COLUMN trip SET DEFAULT 0, DROP CONSTRAINT chunk_dirty_pkey,
            ADD PRIMARY KEY (chunk, trip);
        DROP INDEX macadam.chunk_dirty_since; -- old marks come first, young ones are few
        COMMENT ON COLUMN macadam.chunk_dirty.trip IS 'Row of the trip that brought drives, 0: another cause; who fused removes the rows that he read before the drives, so that none is lost';
        COMMENT ON COLUMN macadam.chunk_dirty.since_ms IS 'Time of the mark, ms since 1970 UTC';
    END IF;
END $$;
)";

// Rows come in the order of the audit, so that an index of ranges of blocks, some kB, tells where
// the old ones are.
const char* const old_changes_migration_sql = R"(
CREATE INDEX IF NOT EXISTS state_change_audit ON macadam.state_change USING brin (audit) WITH (autosummarize = on);
COMMENT ON INDEX macadam.state_change_audit IS 'Values by operation, to remove old ones';
)";

// What commands that read a part ask of the whole.
const char* const seen_migration_sql = R"(
CREATE INDEX IF NOT EXISTS segment_state_first_seen ON macadam.segment_state (first_seen_ms);
CREATE INDEX IF NOT EXISTS segment_state_last_seen ON macadam.segment_state (last_seen_ms);
COMMENT ON INDEX macadam.segment_state_first_seen IS 'The first pass of all';
COMMENT ON INDEX macadam.segment_state_last_seen IS 'The last pass of all';
)";

// Marks tell trips apart, and whoever imports adds trips but changes and removes none. What QGIS
// shows explains its columns.
const char* const narrow_rights_migration_sql = R"(
DO $$
BEGIN
    IF EXISTS (SELECT FROM pg_roles WHERE rolname = 'macadam_reader')
       AND has_table_privilege('macadam_reader', 'macadam.chunk_dirty', 'SELECT') THEN
        REVOKE SELECT ON macadam.chunk_dirty FROM macadam_reader;
        GRANT SELECT (chunk) ON macadam.chunk_dirty TO macadam_reader;
    END IF;
    IF EXISTS (SELECT FROM pg_roles WHERE rolname = 'macadam_importer') THEN
        REVOKE UPDATE, DELETE ON macadam.vehicle, macadam.trip, macadam.row_reason, macadam.event,
            macadam.event_search FROM macadam_importer;
        REVOKE UPDATE ON macadam.drive, macadam.audit FROM macadam_importer;
        GRANT UPDATE (trip_id) ON macadam.trip TO macadam_importer; -- a commit that waits for a standby
    END IF;
END $$;
COMMENT ON COLUMN macadam.pass.cell IS 'Map tile of zoom 8 that holds the first node of the way, as the number of its quadkey';
COMMENT ON COLUMN macadam.pass.segment IS 'Row of the segment';
COMMENT ON COLUMN macadam.pass.trip IS 'Row of the trip';
COMMENT ON COLUMN macadam.pass.occurrence IS 'Number of earlier passes of the trip over the segment';
COMMENT ON COLUMN macadam.pass.iri_left_um IS 'IRI of the left track, um/m';
COMMENT ON COLUMN macadam.pass.iri_right_um IS 'IRI of the right track, um/m';
COMMENT ON COLUMN macadam.pass.iri_centre_um IS 'IRI of the mean of both profiles (HRI), um/m';
COMMENT ON COLUMN macadam.pass.iri_um IS 'IRI that is fused, um/m';
COMMENT ON COLUMN macadam.pass.sd_um IS 'Standard uncertainty of iri_um, um/m';
COMMENT ON COLUMN macadam.pass.centre_only IS 'MRI was estimated from HRI';
COMMENT ON COLUMN macadam.pass.validity IS 'Sum of 1 too slow, 2 start-up, 4 gap, 8 indicative, 16 lateral vibration alone';
COMMENT ON COLUMN macadam.pass.speed_mmps IS 'Mean speed, mm/s';
COMMENT ON COLUMN macadam.pass.covered_mm IS 'Length of the segment that was driven, mm';
COMMENT ON COLUMN macadam.pass.confidence_ppm IS 'Confidence of the map matching, ppm';
COMMENT ON COLUMN macadam.pass.t_ms IS 'Time of the middle since the start of the trip, ms';
COMMENT ON COLUMN macadam.pass.drive IS 'Number of the drive over its chunk; NULL: not known';
COMMENT ON COLUMN macadam.roughness.fid IS 'Row of the segment';
COMMENT ON COLUMN macadam.roughness.geom IS 'Line';
COMMENT ON COLUMN macadam.roughness.segment IS 'Key: way, + forward or - backward, number';
COMMENT ON COLUMN macadam.roughness.way_id IS 'Way that it is a part of';
COMMENT ON COLUMN macadam.roughness.name IS 'Name of the road';
COMMENT ON COLUMN macadam.roughness.highway IS 'Class of OpenStreetMap';
COMMENT ON COLUMN macadam.roughness.direction IS 'forward or backward along the way';
COMMENT ON COLUMN macadam.roughness.from_m IS 'Begin along the way, m';
COMMENT ON COLUMN macadam.roughness.to_m IS 'End along the way, m';
COMMENT ON COLUMN macadam.roughness.iri IS 'IRI, mm/m';
COMMENT ON COLUMN macadam.roughness.iri_sd IS 'Standard uncertainty of iri, mm/m';
COMMENT ON COLUMN macadam.roughness.iri_low IS 'Lower end of its interval of 90 %, mm/m';
COMMENT ON COLUMN macadam.roughness.iri_high IS 'Upper end of its interval of 90 %, mm/m';
COMMENT ON COLUMN macadam.roughness.iri_left IS 'IRI of the left track, mm/m';
COMMENT ON COLUMN macadam.roughness.iri_right IS 'IRI of the right track, mm/m';
COMMENT ON COLUMN macadam.roughness."index" IS 'MRI, or HRI>MRI where it was estimated from HRI';
COMMENT ON COLUMN macadam.roughness.class IS 'Roughness class';
COMMENT ON COLUMN macadam.roughness.passes IS 'Passes of cars';
COMMENT ON COLUMN macadam.roughness.vehicles IS 'Cars';
COMMENT ON COLUMN macadam.roughness.first_seen IS 'Day of the first pass, UTC';
COMMENT ON COLUMN macadam.roughness.last_seen IS 'Day of the last pass, UTC';
COMMENT ON COLUMN macadam.roughness.trend_per_year IS 'Trend of iri, mm/m a year';
COMMENT ON COLUMN macadam.roughness.trend_sd IS 'Its standard uncertainty, mm/m a year';
COMMENT ON COLUMN macadam.roughness.changed IS 'Day of the first pass after a step of the road, UTC';
COMMENT ON COLUMN macadam.roughness.change IS 'Level after it minus level before, mm/m';
COMMENT ON COLUMN macadam.roughness.validity IS 'What limits the value, in words';
)";

namespace {

// A crowd's raw logs leave the object store whatever became of them.
constexpr const char* publications = R"(
CREATE INDEX published_pending_of_trip ON macadam.published_pending (trip);
COMMENT ON INDEX macadam.published_pending_of_trip IS 'Waiting passes of a trip, to forget it';
DROP INDEX macadam.job_to_erase;
CREATE INDEX job_to_erase ON macadam.job (number) WHERE has_object AND state IN ('imported', 'known', 'outside', 'refused');
COMMENT ON INDEX macadam.job_to_erase IS 'Logs that the object store may no longer need';
INSERT INTO macadam.meta VALUES ('published_rows', gen_random_uuid()::text) ON CONFLICT (key) DO NOTHING;
)";

} // namespace

std::string publications_migration_sql() {
    const std::string tables = " ON macadam.publication, macadam.published_state,"
                               " macadam.published_until, macadam.published_pending,"
                               " macadam.published_figure, macadam.published_event";
    return publications + granting("SELECT" + tables, {"macadam_importer", "macadam_operator"}) +
           granting("INSERT, UPDATE, DELETE" + tables, {"macadam_operator"});
}

} // namespace macadam
