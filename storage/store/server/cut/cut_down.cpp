#include "storage/store/server/cut/cut_down.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/build_network.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/schema/network_rows.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/server/copy/new_copy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>
#include <vector>

namespace macadam {
namespace {

struct Column {
    const char* table;
    const char* name;
};

/// Columns that refer to segments, or to chunks by their first segments.
constexpr std::array segment_columns{Column{"pass", "segment"},
                                     Column{"trace", "strip"},
                                     Column{"event", "segment"},
                                     Column{"segment_state", "fid"},
                                     Column{"strip_state", "strip"},
                                     Column{"segment_dirty", "segment"},
                                     Column{"strip_dirty", "strip"},
                                     Column{"valid_from", "segment"},
                                     Column{"state_change", "segment"},
                                     Column{"published_state", "fid"},
                                     Column{"published_until", "segment"},
                                     Column{"published_pending", "segment"},
                                     Column{"published_figure", "segment"},
                                     Column{"published_event", "segment"}};
constexpr std::array trip_columns{
    Column{"row_reason", "trip"}, Column{"event_search", "trip"}, Column{"trip", "id"}};
constexpr std::array car_columns{Column{"calibration", "vehicle"},
                                 Column{"calibration_period", "vehicle"},
                                 Column{"vehicle", "id"}};

constexpr const char* make_lists = "CREATE TEMP TABLE cut_segment (fid INTEGER PRIMARY KEY);"
                                   "CREATE TEMP TABLE cut_trip (id INTEGER PRIMARY KEY);"
                                   "CREATE TEMP TABLE cut_way (way_id INTEGER PRIMARY KEY);"
                                   "CREATE TEMP TABLE cut_road (way_id INTEGER PRIMARY KEY)";
constexpr const char* remove_lists = "DROP TABLE temp.cut_segment; DROP TABLE temp.cut_trip;"
                                     "DROP TABLE temp.cut_way; DROP TABLE temp.cut_road";

void keep_only(Database& file, std::span<const Column> columns, const char* list) {
    for (const auto& [table, name] : columns) {
        file.run(fmt::format("DELETE FROM {} WHERE {} NOT IN ({})", table, name, list));
    }
}

/// Lists the segments of the chunks, and their ways.
void list_segments(Database& file,
                   std::span<const std::int64_t> chunks,
                   std::int64_t segments_per_chunk) {
    auto add = file.prepare("INSERT INTO temp.cut_segment SELECT fid FROM segment"
                            " WHERE fid >= ?1 AND fid < ?1 + ?2 AND strip = ?1");
    for (const auto chunk : chunks) {
        add.run(chunk, segments_per_chunk);
    }
    file.run("INSERT INTO temp.cut_way SELECT DISTINCT way_id FROM temp.cut_segment AS cut"
             " CROSS JOIN segment ON segment.fid = cut.fid");
}

void remove_readings(Database& file) {
    keep_only(file, segment_columns, "SELECT fid FROM temp.cut_segment");
    file.run("INSERT INTO temp.cut_trip SELECT trip FROM pass UNION SELECT trip FROM trace");
    keep_only(file, trip_columns, "SELECT id FROM temp.cut_trip");
    keep_only(file, car_columns, "SELECT vehicle FROM trip WHERE vehicle IS NOT NULL");
    file.run("DELETE FROM audit WHERE id NOT IN (SELECT audit FROM state_change)");
}

std::unordered_set<std::int64_t> ways_of_chunks(Database& file) {
    std::unordered_set<std::int64_t> ids;
    auto select = file.prepare("SELECT way_id FROM temp.cut_way");
    while (select.step()) {
        ids.insert(select.integer(0));
    }
    return ids;
}

/// Builds the network of some ways and of those that have a node of them.
RoadNetwork
roads_around(Database& file, const std::unordered_set<std::int64_t>& ids, double segment_length_m) {
    auto ways = read_ways(file);
    std::unordered_set<std::int64_t> nodes;
    for (const auto& way : ways) {
        if (ids.contains(way.id)) {
            nodes.insert(way.node_ids.begin(), way.node_ids.end());
        }
    }
    std::erase_if(ways, [&](const Way& way) {
        return std::ranges::none_of(way.node_ids,
                                    [&](std::int64_t node) { return nodes.contains(node); });
    });
    return build_network(std::move(ways), segment_length_m);
}

/// Replaces all roads; segments of ways of chunks stay.
void replace_roads(Database& file,
                   const RoadNetwork& roads,
                   const std::unordered_set<std::int64_t>& ways_of_chunks,
                   const Progress& progress) {
    file.run("DELETE FROM segment WHERE way_id NOT IN (SELECT way_id FROM temp.cut_way);"
             "DELETE FROM control_section WHERE way_id NOT IN (SELECT way_id FROM temp.cut_way)");
    std::vector<bool> stay;
    auto add = file.prepare("INSERT INTO temp.cut_road VALUES (?)");
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        const auto id = way_at(roads, i).id;
        add.run(id);
        stay.push_back(ways_of_chunks.contains(id));
    }
    file.run("DELETE FROM way WHERE way_id NOT IN (SELECT way_id FROM temp.cut_road);"
             "DELETE FROM road_ref WHERE way_id NOT IN (SELECT way_id FROM temp.cut_road)");
    reserve_published_rows(file);
    write_segments(file, roads, {.report = {}, .stop = progress.stop}, stay);
    file.run("DELETE FROM rtree_segment_geom;"
             "INSERT INTO rtree_segment_geom SELECT fid, ST_MinX(geom), ST_MaxX(geom),"
             " ST_MinY(geom), ST_MaxY(geom) FROM segment");
}

void update_settings(Database& file, const RoadNetwork& roads, const StoreSettings& settings) {
    const auto segments = count_segments(roads);
    if (file.number("SELECT count(*) FROM segment") != segments.segments) {
        throw InputError{fmt::format("{}: the segments of its roads are not those of its ways; the "
                                     "database was modified by another program",
                                     file.file().string())};
    }
    update_network_meta(file,
                        {settings.network_source,
                         settings.attribution,
                         hash_of_ways(roads),
                         segments.segments,
                         segments.length_m});
    update_extent(file, extent_of(roads));
}

} // namespace

void cut_down(Database& file,
              std::span<const std::int64_t> chunks,
              const std::string& cut_from,
              const Progress& progress) {
    const auto settings = read_settings(file);
    Transaction all{file, Transaction::Kind::write};
    file.run(make_lists);
    list_segments(file, chunks, segments_per_chunk(settings.segment_length_m));
    remove_readings(file);
    const auto ways = ways_of_chunks(file);
    const auto roads = roads_around(file, ways, settings.segment_length_m);
    remove_index_triggers(file, "segment");
    replace_roads(file, roads, ways, progress);
    add_index_triggers(file, "segment");
    update_settings(file, roads, settings);
    add_audit(file, "cut", cut_from);
    file.run(remove_lists);
    all.commit();
    file.run("VACUUM");
}

} // namespace macadam
