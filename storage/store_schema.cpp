#include "storage/store_schema.hpp"

#include "estimator/common/error.hpp"
#include "mapping/strip_trace.hpp"
#include "storage/geopackage.hpp"
#include "storage/sha256.hpp"
#include "storage/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

namespace macadam {
namespace {

constexpr int store_version = 2;
constexpr const char* format_name = "macadam-store";

// Column types are those that a GeoPackage knows; it forbids STRICT, whose types are others.
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
    vehicle INTEGER NOT NULL REFERENCES vehicle(id),
    file_name TEXT NOT NULL,
    t0_utc_ms INTEGER,
    vehicle_model TEXT NOT NULL,
    method TEXT NOT NULL,
    distance_mm INTEGER NOT NULL,
    matched_mm INTEGER NOT NULL,
    rows_read INTEGER NOT NULL,
    rows_used INTEGER NOT NULL
);
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
CREATE TABLE strip_state (
    strip INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid),
    drives INTEGER NOT NULL,
    found INTEGER NOT NULL,
    beyond_reach INTEGER NOT NULL,
    moved_far INTEGER NOT NULL,
    middle_lag_cm INTEGER NOT NULL
);
CREATE TABLE segment_state (
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
    first_seen DATETIME,
    last_seen DATETIME,
    trend_per_year DOUBLE,
    trend_sd DOUBLE,
    changed DATETIME,
    change DOUBLE,
    validity TEXT NOT NULL,
    first_seen_ms INTEGER,
    last_seen_ms INTEGER,
    changed_ms INTEGER,
    flags INTEGER NOT NULL
);
CREATE TABLE segment_dirty (
    segment INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid)
);
CREATE VIEW roughness AS
    SELECT segment.fid AS OGC_FID, segment.geom, segment.segment, segment.way_id, way.name,
           way.highway, segment.direction, segment.from_m, segment.to_m,
           state.iri, state.iri_sd, state.iri_low, state.iri_high, state.iri_left, state.iri_right,
           state."index", state.class, state.passes, state.vehicles, state.first_seen,
           state.last_seen, state.trend_per_year, state.trend_sd, state.changed, state.change,
           state.validity
    FROM segment_state AS state
    JOIN segment ON segment.fid = state.fid
    JOIN way ON way.way_id = segment.way_id;
)";

// ------------------------------------------------------------------------------------- network

template <typename Values>
std::string bytes_of(const Values& values) {
    std::string bytes;
    bytes.reserve(values.size() * sizeof(values[0]));
    for (const auto& value : values) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    return bytes;
}

template <typename Value>
std::vector<Value> values_of(std::string_view bytes) {
    std::vector<Value> values(bytes.size() / sizeof(Value));
    if (!values.empty()) {
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
    }
    return values;
}

/// Two doubles, latitude first, and three integers: their own layouts in memory.
static_assert(sizeof(GeoPoint) == 2 * sizeof(double));
static_assert(sizeof(TurnRule) == 3 * sizeof(std::int64_t));

std::optional<std::string_view> unless_empty(std::string_view text) {
    return text.empty() ? std::nullopt : std::optional{text};
}

/// \returns SHA-256 of all that was written.
std::string write_ways(Database& database, const RoadNetwork& roads) {
    auto insert = database.prepare("INSERT INTO way VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    Sha256 hash;
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        const auto way = way_at(roads, i);
        const auto node_ids = bytes_of(way.node_ids);
        const auto points = bytes_of(way.line);
        const auto turns = bytes_of(way.turns);
        insert.run(way.id,
                   unless_empty(way.name),
                   unless_empty(way.highway),
                   static_cast<int>(way.oneway),
                   Blob{node_ids},
                   Blob{points},
                   std::int64_t{way.speed_limit_cmps},
                   Blob{turns});
        hash.add(fmt::format("{} {} {} {} {} {} {}\n{}\n{}\n",
                             way.id,
                             way.name.size(),
                             way.highway.size(),
                             static_cast<int>(way.oneway),
                             way.line.size(),
                             way.speed_limit_cmps,
                             way.turns.size(),
                             way.name,
                             way.highway));
        hash.add(node_ids);
        hash.add(points);
        hash.add(turns);
    }
    return hash.hex();
}

/// Of the links [first, last), one way's, in one direction; by their number along the way.
std::vector<Segment>
drivable_segments(const RoadNetwork& roads, std::uint32_t first, std::uint32_t last, bool forward) {
    std::vector<Segment> all;
    for (auto i = first; i < last; ++i) {
        const auto edge = edge_of(LinkId{i}, forward);
        if (is_drivable(roads, edge)) {
            auto segments = segments_of(roads, edge);
            all.insert(all.end(),
                       std::make_move_iterator(segments.begin()),
                       std::make_move_iterator(segments.end()));
        }
    }
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return all;
}

struct Written {
    std::int64_t segments = 0;
    double length_m = 0;
};

Written write_segments(Database& database, const RoadNetwork& roads, const Progress& progress) {
    auto insert =
        database.prepare("INSERT INTO segment (geom, segment, way_id, direction, seq, from_m, to_m,"
                         " strip) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    Written written;
    std::optional<StripKey> strip;
    std::int64_t first_of_strip = 0; // its row, of those that count from 1
    const auto count = link_count(roads);
    for (std::uint32_t first = 0, last = 0; first < count; first = last) {
        while (last < count &&
               link_at(roads, LinkId{last}).way == link_at(roads, LinkId{first}).way) {
            ++last;
        }
        for (const bool forward : {true, false}) {
            for (const auto& segment : drivable_segments(roads, first, last, forward)) {
                if (const auto key = strip_of(segment.key, roads.segment_length_m); strip != key) {
                    strip = key;
                    first_of_strip = written.segments + 1;
                }
                insert.run(Blob{geometry_of(segment.line)},
                           name_of(segment.key),
                           segment.key.way_id,
                           forward ? "forward" : "backward",
                           std::int64_t{segment.key.index},
                           segment.from_m,
                           segment.to_m,
                           first_of_strip);
                ++written.segments;
                written.length_m += segment.to_m - segment.from_m;
            }
        }
        progress(last, count);
        if (progress.stop.stop_requested()) {
            throw InputError{
                fmt::format("{}: stopped before it was whole", database.file().string())};
        }
    }
    return written;
}

/// What a network can be built of.
void expect_sound(const Way& way, const Database& database) {
    const bool sound = is_line(way.line) && way.line.size() == way.node_ids.size() &&
                       way.oneway <= Oneway::backward;
    if (!sound) {
        throw InputError{fmt::format("{}: way '{}' is no line of places on the globe, each with "
                                     "its node; the store was changed",
                                     database.file().string(),
                                     way.id)};
    }
}

// ---------------------------------------------------------------------------------------- meta

constexpr double least_segment_m = 0.1; // far below and above what 'macadam init' takes
constexpr double most_segment_m = 100'000;

void put(Database& database, std::string_view key, std::string_view value) {
    database.prepare("INSERT INTO meta VALUES (?, ?)").run(key, value);
}

std::string meta(Database& database, std::string_view key) {
    auto statement = database.prepare("SELECT value FROM meta WHERE key = ?");
    return statement.bind(key).step() ? statement.text(0) : std::string{};
}

double real_meta(Database& database, std::string_view key) {
    const auto text = meta(database, key);
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

void write_meta(Database& database,
                const RoadNetwork& roads,
                const StoreSettings& settings,
                const std::string& network_hash,
                const Written& written) {
    put(database, "format", format_name);
    put(database, "version", fmt::format("{}", store_version));
    put(database, "segment_length_m", fmt::format("{}", roads.segment_length_m));
    put(database, "class_table", settings.class_table);
    put(database, "network_source", settings.network_source);
    put(database, "attribution", settings.attribution);
    put(database, "network_sha256", network_hash);
    put(database, "segments", fmt::format("{}", written.segments));
    put(database, "network_m", fmt::format("{}", written.length_m));
}

bool has_table(Database& database, std::string_view name) {
    auto statement =
        database.prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?");
    return statement.bind(name).step();
}

std::string_view what_to_do_with(const std::string& version) {
    int number = 0;
    std::from_chars(version.data(), version.data() + version.size(), number);
    return number > store_version ? "it was made by a newer macadam, which can read it"
                                  : "make it anew with 'macadam init' and import its trips again";
}

} // namespace

bool is_line(std::span<const GeoPoint> line) {
    return line.size() >= 2 && std::ranges::all_of(line, [](const GeoPoint& at) {
               return std::abs(at.lat_deg) <= 90 && std::abs(at.lon_deg) <= 180;
           });
}

void write_store(Database& database,
                 const RoadNetwork& roads,
                 const StoreSettings& settings,
                 const Progress& progress) {
    const auto* classes = class_table(settings.class_table);
    if (classes == nullptr) {
        throw InputError{
            fmt::format("class table '{}', expected fhwa or five", settings.class_table)};
    }
    Transaction all{database, Transaction::Kind::write};
    make_geopackage(database);
    database.run(tables);
    const auto network_hash = write_ways(database, roads);
    const auto written = write_segments(database, roads, progress);
    database.run("CREATE UNIQUE INDEX segment_key ON segment(way_id, direction, seq)");
    database.run("CREATE INDEX way_name ON way(name)");
    write_meta(database, roads, settings, network_hash, written);

    const auto box = extent_of(roads);
    list_features(database, {"segment", "segment", "Pieces of road, one for each direction", box});
    list_features(database,
                  {"roughness", "roughness", "Roughness (IRI, mm/m) of the segments driven", box});
    index_features(database, "segment");
    add_default_style(database, "roughness", *classes);
    all.commit();
}

void check_store(Database& database) {
    const auto refuse = [&](std::string_view what, std::string_view is) {
        throw InputError{fmt::format(
            "{}: {}, expected one made by 'macadam init'{}", database.file().string(), what, is)};
    };
    if (const auto id = database.number("PRAGMA application_id"); id != geopackage_application_id) {
        refuse("is no store",
               id == 0 ? "; it is an SQLite database that no application has marked"
                       : fmt::format("; it is an SQLite database of another application "
                                     "({:#010x})",
                                     static_cast<std::uint32_t>(id)));
    }
    if (!has_table(database, "meta") || meta(database, "format") != format_name) {
        refuse("is a GeoPackage but no Macadam store", "");
    }
    if (const auto version = meta(database, "version"); version != std::to_string(store_version)) {
        throw InputError{fmt::format("{}: is a store of version {}, expected version {}: {}",
                                     database.file().string(),
                                     in_quotes(version),
                                     store_version,
                                     what_to_do_with(version))};
    }
}

StoreSettings read_settings(Database& database) {
    StoreSettings settings{.segment_length_m = real_meta(database, "segment_length_m"),
                           .class_table = meta(database, "class_table"),
                           .network_source = meta(database, "network_source"),
                           .attribution = meta(database, "attribution")};
    const auto refuse = [&](std::string_view key, std::string_view expected) {
        throw InputError{fmt::format("{}: {} is {}, expected {}; the store was changed",
                                     database.file().string(),
                                     key,
                                     in_quotes(meta(database, key)),
                                     expected)};
    };
    if (class_table(settings.class_table) == nullptr) {
        refuse("class_table", "fhwa or five");
    }
    if (!(settings.segment_length_m >= least_segment_m &&
          settings.segment_length_m <= most_segment_m)) {
        refuse("segment_length_m", "a length of segments");
    }
    return settings;
}

std::string read_network_hash(Database& database) {
    return meta(database, "network_sha256");
}

std::vector<Way> read_ways(Database& database) {
    auto select = database.prepare(
        "SELECT way_id, name, highway, oneway, node_ids, points, speed_limit_cmps, turns"
        " FROM way ORDER BY way_id");
    std::vector<Way> ways;
    while (select.step()) {
        ways.push_back({.id = select.integer(0),
                        .name = select.text(1),
                        .highway = select.text(2),
                        .oneway = static_cast<Oneway>(select.integer(3)),
                        .node_ids = values_of<std::int64_t>(select.blob(4)),
                        .line = values_of<GeoPoint>(select.blob(5)),
                        .speed_limit_cmps = static_cast<std::uint16_t>(select.integer(6)),
                        .turns = values_of<TurnRule>(select.blob(7))});
        expect_sound(ways.back(), database);
    }
    return ways;
}

} // namespace macadam
