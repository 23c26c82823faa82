#include "storage/store/schema/schema_sql.hpp"

#include <fmt/format.h>

namespace macadam {

namespace {

/// Columns of fused values, for those of all passes and for those that a crowd publishes.
constexpr const char* state_columns = R"(
    fid INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid),
    iri DOUBLE NOT NULL,
    iri_sd DOUBLE NOT NULL,
    iri_low DOUBLE NOT NULL,
    iri_high DOUBLE NOT NULL,
    iri_left DOUBLE,
    iri_right DOUBLE,
    "index" TEXT NOT NULL,
    class TEXT NOT NULL,
    passes INTEGER NOT NULL,
    vehicles INTEGER NOT NULL,
    first_seen DATE,
    last_seen DATE,
    trend_per_year DOUBLE,
    trend_sd DOUBLE,
    changed DATE,
    change DOUBLE,
    validity TEXT NOT NULL,
    first_seen_ms INTEGER,
    last_seen_ms INTEGER,
    changed_ms INTEGER,
    flags INTEGER NOT NULL
)";

// Column types are those of a GeoPackage; it forbids STRICT, which has other types. A column that
// came later stands where ALTER TABLE puts it, so that upgraded databases have the same text.
constexpr const char* tables = R"(
CREATE TABLE meta (
    key TEXT PRIMARY KEY NOT NULL,
    value TEXT NOT NULL
) WITHOUT ROWID;
CREATE TABLE way (
    way_id INTEGER PRIMARY KEY NOT NULL,
    name TEXT,
    highway TEXT,
    oneway SMALLINT NOT NULL,
    node_ids BLOB NOT NULL,
    points BLOB NOT NULL,
    speed_limit_cmps INTEGER NOT NULL,
    turns BLOB NOT NULL
);
CREATE TABLE background (
    zoom INTEGER NOT NULL,
    tile_x INTEGER NOT NULL,
    tile_y INTEGER NOT NULL,
    part INTEGER NOT NULL,
    pieces BLOB NOT NULL,
    PRIMARY KEY (zoom, tile_x, tile_y, part)
) WITHOUT ROWID;
CREATE TABLE place (
    id INTEGER PRIMARY KEY NOT NULL,
    name TEXT NOT NULL,
    rank INTEGER NOT NULL,
    lat_e7 INTEGER NOT NULL,
    lon_e7 INTEGER NOT NULL,
    population INTEGER NOT NULL
);
CREATE TABLE road_ref (
    way_id INTEGER PRIMARY KEY NOT NULL,
    ref TEXT NOT NULL
);
CREATE TABLE segment (
    fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,
    geom LINESTRING,
    segment TEXT NOT NULL,
    way_id INTEGER NOT NULL REFERENCES way(way_id),
    direction TEXT NOT NULL,
    seq INTEGER NOT NULL,
    from_m DOUBLE NOT NULL,
    to_m DOUBLE NOT NULL,
    strip INTEGER NOT NULL
);
CREATE TABLE vehicle (
    id INTEGER PRIMARY KEY,
    pseudonym TEXT NOT NULL UNIQUE
);
CREATE TABLE trip (
    id INTEGER PRIMARY KEY,
    sha256 TEXT NOT NULL UNIQUE,
    trip_id TEXT NOT NULL,
    vehicle INTEGER REFERENCES vehicle(id),
    file_name TEXT NOT NULL,
    t0_utc_ms INTEGER,
    vehicle_model TEXT NOT NULL,
    method TEXT NOT NULL,
    distance_mm INTEGER NOT NULL,
    matched_mm INTEGER NOT NULL,
    rows_read INTEGER NOT NULL,
    rows_used INTEGER NOT NULL,
    calibrates INTEGER NOT NULL DEFAULT 0,
    reference_ppm INTEGER,
    reference_row_mm INTEGER
, {1});
CREATE TABLE pass (
    segment INTEGER NOT NULL REFERENCES segment(fid),
    trip INTEGER NOT NULL REFERENCES trip(id),
    occurrence INTEGER NOT NULL,
    iri_left_um INTEGER,
    iri_right_um INTEGER,
    iri_centre_um INTEGER,
    iri_um INTEGER NOT NULL,
    sd_um INTEGER NOT NULL,
    centre_only INTEGER NOT NULL,
    validity INTEGER NOT NULL,
    speed_mmps INTEGER NOT NULL,
    covered_mm INTEGER NOT NULL,
    confidence_ppm INTEGER NOT NULL,
    t_ms INTEGER NOT NULL,
    drive INTEGER,
    PRIMARY KEY (segment, trip, occurrence)
) WITHOUT ROWID;
CREATE INDEX pass_of_trip ON pass(trip);
CREATE TABLE trace (
    strip INTEGER NOT NULL REFERENCES segment(fid),
    trip INTEGER NOT NULL REFERENCES trip(id),
    drive INTEGER NOT NULL,
    first_m INTEGER NOT NULL,
    place_sd_mm INTEGER NOT NULL,
    iri BLOB NOT NULL,
    iri_left BLOB,
    PRIMARY KEY (strip, trip, drive)
) WITHOUT ROWID;
CREATE INDEX trace_of_trip ON trace(trip);
CREATE TABLE event (
    segment INTEGER NOT NULL REFERENCES segment(fid),
    trip INTEGER NOT NULL REFERENCES trip(id),
    occurrence INTEGER NOT NULL,
    number INTEGER NOT NULL,
    kind INTEGER NOT NULL,
    track INTEGER NOT NULL,
    at_mm INTEGER NOT NULL,
    place_sd_mm INTEGER NOT NULL,
    size_um INTEGER NOT NULL,
    sd_um INTEGER NOT NULL,
    length_mm INTEGER NOT NULL,
    PRIMARY KEY (segment, trip, occurrence, number)
) WITHOUT ROWID;
CREATE INDEX event_of_trip ON event(trip);
CREATE TABLE event_search (
    trip INTEGER PRIMARY KEY NOT NULL REFERENCES trip(id)
);
CREATE TABLE strip_state (
    strip INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid),
    drives INTEGER NOT NULL,
    found INTEGER NOT NULL,
    beyond_reach INTEGER NOT NULL,
    moved_far INTEGER NOT NULL,
    middle_lag_cm INTEGER NOT NULL
);
CREATE TABLE segment_state ({0});
CREATE TABLE control_section (
    name TEXT PRIMARY KEY NOT NULL,
    way_id INTEGER NOT NULL REFERENCES way(way_id),
    direction TEXT NOT NULL,
    from_mm INTEGER NOT NULL,
    to_mm INTEGER NOT NULL,
    iri_um INTEGER NOT NULL,
    sd_um INTEGER NOT NULL,
    utc_ms INTEGER
) WITHOUT ROWID;
CREATE TABLE segment_dirty (
    segment INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid)
);
CREATE TABLE row_reason (
    trip INTEGER NOT NULL REFERENCES trip(id),
    reason TEXT NOT NULL,
    rows INTEGER NOT NULL,
    PRIMARY KEY (trip, reason)
) WITHOUT ROWID;
CREATE TABLE import_note (
    name TEXT PRIMARY KEY NOT NULL,
    asked INTEGER NOT NULL,
    trips_before INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE strip_dirty (
    strip INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid)
);
CREATE TABLE fusion_setting (
    key TEXT PRIMARY KEY NOT NULL,
    value INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE calibration (
    vehicle INTEGER PRIMARY KEY NOT NULL REFERENCES vehicle(id),
    gain_ppm INTEGER NOT NULL,
    offset_um INTEGER NOT NULL,
    sd_ppm INTEGER NOT NULL,
    trips INTEGER NOT NULL,
    passes INTEGER NOT NULL
);
CREATE TABLE calibration_period (
    vehicle INTEGER NOT NULL REFERENCES vehicle(id),
    number INTEGER NOT NULL,
    from_ms INTEGER,
    gain_ppm INTEGER,
    offset_um INTEGER,
    sd_ppm INTEGER,
    scatter_ppm INTEGER NOT NULL,
    passes INTEGER NOT NULL,
    change_ppm INTEGER,
    change_sd_ppm INTEGER,
    change_scatter_ppm INTEGER,
    PRIMARY KEY (vehicle, number)
) WITHOUT ROWID;
CREATE TABLE valid_from (
    segment INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid),
    from_ms INTEGER NOT NULL
);
CREATE TABLE audit (
    id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,
    at DATETIME NOT NULL,
    generation INTEGER NOT NULL,
    what TEXT NOT NULL,
    detail TEXT NOT NULL
);
CREATE TABLE state_change (
    segment INTEGER NOT NULL REFERENCES segment(fid),
    audit INTEGER NOT NULL REFERENCES audit(id),
    iri_um INTEGER,
    sd_um INTEGER,
    passes INTEGER NOT NULL,
    PRIMARY KEY (segment, audit)
) WITHOUT ROWID;
CREATE TABLE forgotten (
    mark TEXT PRIMARY KEY NOT NULL
) WITHOUT ROWID;
CREATE TABLE publication (
    number INTEGER PRIMARY KEY NOT NULL,
    month TEXT NOT NULL UNIQUE,
    last_trip INTEGER NOT NULL,
    last_segment INTEGER NOT NULL,
    segments INTEGER NOT NULL,
    length_m DOUBLE NOT NULL,
    left_segments INTEGER NOT NULL,
    left_m DOUBLE NOT NULL,
    trips INTEGER NOT NULL,
    cars INTEGER NOT NULL
);
CREATE TABLE published_state ({0});
CREATE TABLE published_until (
    segment INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid),
    last_trip INTEGER NOT NULL
);
CREATE TABLE published_pending (
    segment INTEGER NOT NULL REFERENCES segment(fid),
    trip INTEGER NOT NULL REFERENCES trip(id),
    occurrence INTEGER NOT NULL,
    PRIMARY KEY (segment, trip, occurrence)
) WITHOUT ROWID;
CREATE INDEX published_pending_of_trip ON published_pending(trip);
CREATE TABLE published_figure (
    segment INTEGER NOT NULL REFERENCES segment(fid),
    number INTEGER NOT NULL,
    publication INTEGER NOT NULL REFERENCES publication(number) DEFERRABLE INITIALLY DEFERRED,
    from_ms INTEGER,
    until_ms INTEGER,
    iri_um INTEGER NOT NULL,
    sd_um INTEGER NOT NULL,
    low_um INTEGER NOT NULL,
    high_um INTEGER NOT NULL,
    left_um INTEGER,
    right_um INTEGER,
    centre_only INTEGER NOT NULL,
    flags INTEGER NOT NULL,
    passes INTEGER NOT NULL,
    vehicles INTEGER NOT NULL,
    PRIMARY KEY (segment, number)
) WITHOUT ROWID;
CREATE TABLE published_event (
    segment INTEGER NOT NULL REFERENCES segment(fid),
    number INTEGER NOT NULL,
    kind INTEGER NOT NULL,
    track INTEGER NOT NULL,
    at_mm INTEGER NOT NULL,
    place_sd_mm INTEGER NOT NULL,
    size_um INTEGER NOT NULL,
    sd_um INTEGER NOT NULL,
    length_mm INTEGER NOT NULL,
    passes INTEGER NOT NULL,
    passes_over INTEGER NOT NULL,
    vehicles INTEGER NOT NULL,
    first_seen_ms INTEGER,
    last_seen_ms INTEGER,
    PRIMARY KEY (segment, number)
) WITHOUT ROWID;
)";

} // namespace

std::string store_tables() {
    return fmt::format(tables, state_columns, trimmed_column);
}

std::string roughness_layer(PrivacyProfile privacy) {
    const auto* const states =
        privacy == PrivacyProfile::crowd ? "published_state" : "segment_state";
    return fmt::format(R"(
CREATE VIEW roughness AS
    SELECT segment.fid AS OGC_FID, segment.geom, segment.segment, segment.way_id, way.name,
           way.highway, segment.direction, segment.from_m, segment.to_m,
           state.iri, state.iri_sd, state.iri_low, state.iri_high, state.iri_left, state.iri_right,
           state."index", state.class, state.passes, state.vehicles, state.first_seen,
           state.last_seen, state.trend_per_year, state.trend_sd, state.changed, state.change,
           state.validity
    FROM {} AS state
    JOIN segment ON segment.fid = state.fid
    JOIN way ON way.way_id = segment.way_id;
)",
                       states);
}

} // namespace macadam
