#include "storage/store/schema/network_rows.hpp"

#include "estimator/common/error.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/files/sha256.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/bulk_insert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

namespace macadam {
namespace {

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

/// Blob formats equal the memory layouts: two doubles, latitude first, and three integers.
static_assert(sizeof(GeoPoint) == 2 * sizeof(double));
static_assert(sizeof(TurnRule) == 3 * sizeof(std::int64_t));

std::optional<std::string_view> unless_empty(std::string_view text) {
    return text.empty() ? std::nullopt : std::optional{text};
}

constexpr const char* insert_way = "INSERT INTO way VALUES (?, ?, ?, ?, ?, ?, ?, ?)";

void write_way(Statement& insert, const WayView& way) {
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
}

bool says_the_same(const WayView& a, const WayView& b) {
    return a.name == b.name && a.highway == b.highway && a.oneway == b.oneway &&
           a.speed_limit_cmps == b.speed_limit_cmps && std::ranges::equal(a.node_ids, b.node_ids) &&
           std::ranges::equal(a.line.base(), b.line.base()) && std::ranges::equal(a.turns, b.turns);
}

/// First row of table segment that was never used.
std::int64_t first_free_row(Database& database) {
    return 1 + database.number("SELECT coalesce((SELECT seq FROM sqlite_sequence"
                               " WHERE name = 'segment'), 0)");
}

/// Calls `visit` with each segment of a way in one direction, by number along the way, link by
/// link, because a way of a few points may have very many segments.
template <typename Visit>
void for_each_segment(const RoadNetwork& roads, const WayView& way, bool forward, Visit visit) {
    for (auto i = way.first_link; i < way.past_link; ++i) {
        const auto edge = edge_of(LinkId{i}, forward);
        if (is_drivable(roads, edge)) {
            auto segments = segments_of(roads, edge);
            if (!forward) {
                std::reverse(segments.begin(), segments.end());
            }
            std::ranges::for_each(segments, visit);
        }
    }
}

/// Checks that a way is valid input for a network.
void expect_sound(const Way& way, const Database& database) {
    const bool sound = is_line(way.line) && way.line.size() == way.node_ids.size() &&
                       way.oneway <= Oneway::backward;
    if (!sound) {
        throw InputError{fmt::format("{}: way '{}' has no valid line geometry with a node at "
                                     "each point; the database was modified by another program",
                                     database.file().string(),
                                     way.id)};
    }
}

constexpr const char* select_ways =
    "SELECT way_id, name, highway, oneway, node_ids, points, speed_limit_cmps, turns FROM way";

Way way_in(const Statement& row, const Database& database) {
    Way way{.id = row.integer(0),
            .name = row.text(1),
            .highway = row.text(2),
            .oneway = static_cast<Oneway>(row.integer(3)),
            .node_ids = values_of<std::int64_t>(row.blob(4)),
            .line = values_of<GeoPoint>(row.blob(5)),
            .speed_limit_cmps = static_cast<std::uint16_t>(row.integer(6)),
            .turns = values_of<TurnRule>(row.blob(7))};
    expect_sound(way, database);
    return way;
}

} // namespace

bool is_line(std::span<const GeoPoint> line) {
    return line.size() >= 2 && std::ranges::all_of(line, [](const GeoPoint& at) {
               return std::abs(at.lat_deg) <= 90 && std::abs(at.lon_deg) <= 180;
           });
}

std::string write_ways(Database& database, const RoadNetwork& roads) {
    auto insert = database.prepare(insert_way);
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        write_way(insert, way_at(roads, i));
    }
    return hash_of_ways(roads);
}

std::string hash_of_ways(const RoadNetwork& roads) {
    Sha256 hash;
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        const auto way = way_at(roads, i);
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
        hash.add(bytes_of(way.node_ids));
        hash.add(bytes_of(way.line));
        hash.add(bytes_of(way.turns));
    }
    return hash.hex();
}

void update_ways(Database& database, const RoadNetwork& before, const RoadNetwork& after) {
    auto write = database.prepare(
        "INSERT INTO way VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT (way_id) DO UPDATE SET"
        " name = excluded.name, highway = excluded.highway, oneway = excluded.oneway,"
        " node_ids = excluded.node_ids, points = excluded.points,"
        " speed_limit_cmps = excluded.speed_limit_cmps, turns = excluded.turns");
    auto remove = database.prepare("DELETE FROM way WHERE way_id = ?");
    std::uint32_t a = 0;
    for (std::uint32_t b = 0; b <= way_count(after); ++b) {
        const bool is_end = b == way_count(after);
        for (; a < way_count(before) && (is_end || before.ways[a].id < after.ways[b].id); ++a) {
            remove.run(before.ways[a].id);
        }
        const bool is_old =
            !is_end && a < way_count(before) && before.ways[a].id == after.ways[b].id;
        if (!is_end && !(is_old && says_the_same(way_at(before, a), way_at(after, b)))) {
            write_way(write, way_at(after, b));
        }
        a += is_old ? 1 : 0;
    }
}

WrittenSegments write_segments(Database& database,
                               const RoadNetwork& roads,
                               const Progress& progress,
                               const std::vector<bool>& left_out) {
    BulkInsert insert{database, "INSERT INTO segment", 9};
    WrittenSegments written;
    std::optional<ChunkKey> chunk;
    const auto first_row = first_free_row(database);
    std::int64_t first_of_chunk = 0; // row of the chunk's first segment
    const auto add = [&](const Segment& segment) {
        const auto row = first_row + written.segments++;
        if (const auto key = chunk_of(segment.key, roads.segment_length_m); chunk != key) {
            chunk = key;
            first_of_chunk = row;
        }
        insert.add(row,
                   Blob{geometry_of(segment.line)},
                   name_of(segment.key),
                   segment.key.way_id,
                   segment.key.forward ? "forward" : "backward",
                   std::int64_t{segment.key.index},
                   segment.from_m,
                   segment.to_m,
                   first_of_chunk);
        written.length_m += segment.to_m - segment.from_m;
        if (progress.stop.stop_requested()) {
            throw InputError{
                fmt::format("{}: stopped before it was complete", database.file().string())};
        }
    };
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        if (!left_out.empty() && left_out[i]) {
            continue;
        }
        const auto way = way_at(roads, i);
        for_each_segment(roads, way, true, add);
        for_each_segment(roads, way, false, add);
        progress(way.past_link, link_count(roads));
    }
    insert.flush();
    return written;
}

void reserve_published_rows(Database& database) {
    database.run("UPDATE sqlite_sequence SET seq = max(seq, (SELECT coalesce(max(last_segment), 0)"
                 " FROM publication)) WHERE name = 'segment'");
}

WrittenSegments count_segments(const RoadNetwork& roads) {
    WrittenSegments all;
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        const auto link = link_at(roads, LinkId{i});
        const int directions = (link.forward ? 1 : 0) + (link.backward ? 1 : 0);
        all.segments += directions * std::int64_t{link.segments};
        all.length_m += directions * (link.to_m - link.from_m);
    }
    return all;
}

void update_extent(Database& database, const GeoBox& box) {
    database
        .prepare("UPDATE gpkg_contents SET min_x = ?, min_y = ?, max_x = ?, max_y = ?, last_change"
                 " = strftime('%Y-%m-%dT%H:%M:%fZ', 'now') WHERE data_type = 'features'"
                 " AND table_name IN ('segment', 'roughness')")
        .run(box.west_deg, box.south_deg, box.east_deg, box.north_deg);
}

std::vector<Way> read_ways(Database& database) {
    auto select = database.prepare(fmt::format("{} ORDER BY way_id", select_ways));
    std::vector<Way> ways;
    while (select.step()) {
        ways.push_back(way_in(select, database));
    }
    return ways;
}

std::vector<Way> read_ways(Database& database, std::span<const std::int64_t> ids) {
    auto select = database.prepare(fmt::format("{} WHERE way_id = ?", select_ways));
    std::vector<Way> ways;
    for (const auto id : ids) {
        if (select.bind(id).step()) {
            ways.push_back(way_in(select, database));
        }
    }
    return ways;
}

} // namespace macadam
