#include "storage/store/rows/segment_query.hpp"

#include "mapping/geometry/antimeridian.hpp"
#include "mapping/geometry/area.hpp"
#include "mapping/geometry/box_intersection.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/text/case_folding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Access paths to the rows, each with its own index.
enum class AccessPath { range, way, box, all };

/// Returns the box in which all segments of a filter lie, if it has one.
std::optional<GeoBox> box_of(const SegmentFilter& filter) {
    return filter.box ? filter.box : filter.area ? std::optional{filter.area->box()} : std::nullopt;
}

AccessPath road_to(const SegmentFilter& filter) {
    const bool is_in_box = box_of(filter).has_value();
    return filter.ranges || filter.key                                  ? AccessPath::range
           : filter.way_id || (!filter.name_part.empty() && !is_in_box) ? AccessPath::way
           : is_in_box                                                  ? AccessPath::box
                                                                        : AccessPath::all;
}

/// Tests for a scan in row order, which is the order of keys: then rows are visited; otherwise they
/// are sorted and returned.
bool is_scan(AccessPath road, bool rows_in_order) {
    return road == AccessPath::box || (road == AccessPath::all && rows_in_order);
}

/// Builds the query, with the joins in order of execution. Only fixed text is concatenated; values
/// are bound.
std::string select_of(const SegmentFilter& filter, const char* columns, bool rows_in_order) {
    const auto road = road_to(filter);
    const bool visited = is_scan(road, rows_in_order);
    const auto* const state = filter.with_state_only
                                  ? " CROSS JOIN segment_state AS state ON state.fid = segment.fid"
                                  : " LEFT JOIN segment_state AS state ON state.fid = segment.fid";
    auto sql = visited ? select_visited(columns) : fmt::format("SELECT {}", columns);
    sql += " FROM ";
    if (road == AccessPath::all && filter.with_state_only) {
        sql += "segment_state AS state CROSS JOIN segment ON segment.fid = state.fid";
    } else {
        sql += "segment";
        sql += state;
    }
    sql += " WHERE 1";
    if (road == AccessPath::box) {
        sql += " AND segment.fid >= ? AND segment.fid <= ?";
    }
    if (road == AccessPath::way) {
        sql += " AND segment.way_id = ?";
    }
    if (road == AccessPath::range) {
        sql += " AND segment.way_id = ? AND segment.direction = ?"
               " AND segment.seq >= ? AND segment.seq < ?";
    }
    // Within a way, the index has this order: nothing is sorted.
    return visited ? sql : sql + " ORDER BY " + order_of_keys;
}

/// Ways whose name contains the text in any case, in the order of their ids.
std::vector<std::int64_t> ways_named(StatementCache& statements, const std::string& part) {
    const auto folded_part = case_folded(part);
    StatementCache::CachedStatement select{statements,
                                           "SELECT name, way_id FROM way WHERE name IS NOT NULL"};
    std::vector<std::int64_t> ways;
    std::string name;
    bool holds = false;
    while (select->step()) {
        if (auto other = select->text(0); other != name) { // neighbours in the index share names
            name = std::move(other);
            holds = case_folded(name).find(folded_part) != std::string::npos;
        }
        if (holds) {
            ways.push_back(select->integer(1));
        }
    }
    std::ranges::sort(ways);
    return ways;
}

/// Consecutive rows.
struct RowRange {
    std::int64_t first;
    std::int64_t last;
};

/// Rows of segments that may intersect the box, in the order of keys, because SQLite would sort
/// them with all their columns. If the rows are not in the order of keys, each range is of one way.
std::vector<RowRange> rows_near(StatementCache& statements, const GeoBox& box, bool rows_in_order) {
    StatementCache::CachedStatement select{
        statements,
        fmt::format("SELECT id, {} FROM rtree_segment_geom AS place {} WHERE place.maxx >= ?"
                    " AND place.minx <= ? AND place.maxy >= ? AND place.miny <= ?",
                    rows_in_order ? "0" : "segment.way_id",
                    rows_in_order ? "" : "CROSS JOIN segment ON segment.fid = place.id")};
    std::vector<std::pair<std::int64_t, std::int64_t>> rows; // way, row
    for (const auto& [west_deg, south_deg, east_deg, north_deg] : parts_on_globe(box)) {
        for (select->bind(west_deg, east_deg, south_deg, north_deg); select->step();) {
            rows.emplace_back(select->integer(1), select->integer(0));
        }
        select->reset();
    }
    std::ranges::sort(rows);
    rows.erase(std::ranges::unique(rows).begin(), rows.end());
    std::vector<RowRange> ranges;
    std::int64_t way = 0;
    for (const auto& [way_of_row, row] : rows) {
        if (ranges.empty() || way_of_row != way || row != ranges.back().last + 1) {
            ranges.push_back({row, row});
        }
        way = way_of_row;
        ranges.back().last = row;
    }
    return ranges;
}

std::vector<SegmentRange> ranges_of(const SegmentFilter& filter) {
    if (filter.ranges) {
        return *filter.ranges;
    }
    const auto& [way_id, forward, index] = *filter.key;
    return {{way_id, forward, index, index + 1}};
}

} // namespace

void each_segment_row(StatementCache& statements,
                      const SegmentFilter& filter,
                      const char* columns,
                      const VisitRow& visit) {
    const auto road = road_to(filter);
    const bool rows_in_order =
        are_rows_in_order(*StatementCache::CachedStatement{statements, select_rows_in_order});
    StatementCache::CachedStatement select{statements, select_of(filter, columns, rows_in_order)};
    const auto run = [&](const auto&... values) {
        if (is_scan(road, rows_in_order)) {
            RowCallback{visit}.run(*select, values...);
            return;
        }
        for (select->bind(values...); select->step();) {
            visit(VisitedRow{select->values()});
        }
    };
    switch (road) {
    case AccessPath::range:
        for (const auto& [way_id, forward, first, past] : ranges_of(filter)) {
            run(way_id, forward ? "forward" : "backward", std::int64_t{first}, std::int64_t{past});
        }
        return;
    case AccessPath::way:
        for (const auto way : filter.way_id ? std::vector{*filter.way_id}
                                            : ways_named(statements, filter.name_part)) {
            run(way);
        }
        return;
    case AccessPath::box:
        for (const auto& [first, last] : rows_near(statements, *box_of(filter), rows_in_order)) {
            run(first, last);
        }
        return;
    case AccessPath::all:
        run();
    }
}

PlaceCondition::PlaceCondition(const SegmentFilter& filter)
    : boxes_{filter.box ? parts_on_globe(*filter.box) : std::vector<GeoBox>{}}, area_{filter.area} {
}

bool PlaceCondition::holds_for(std::span<const GeoPoint> line) const {
    return (boxes_.empty() || intersects_any(boxes_, line)) && (!area_ || area_->intersects(line));
}

} // namespace macadam
