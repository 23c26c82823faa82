#include "app/trace/match_output.hpp"

#include "app/cli/row_writer.hpp"
#include "mapping/matching/arcs.hpp"
#include "storage/exports/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

std::string_view kind_name(IntervalKind kind) {
    switch (kind) {
    case IntervalKind::road:
        return "road";
    case IntervalKind::off_network:
        return "off_network";
    case IntervalKind::gap:
        break;
    }
    return "gap";
}

std::int64_t end_node_id(const RoadNetwork& roads, EdgeId edge, bool at_start) {
    const auto link = link_at(roads, edge);
    const auto point = is_forward(edge) == at_start ? link.first_point : link.last_point;
    return way_of(roads, edge).node_ids[point];
}

/// Converts an offset on an edge to the distance along its way from the first node.
double along_way_m(const RoadNetwork& roads, EdgeId edge, double offset_m) {
    const auto link = link_at(roads, edge);
    return is_forward(edge) ? link.from_m + offset_m : link.to_m - offset_m;
}

struct Row {
    const MatchedInterval& interval;
    const RoadNetwork& roads;
};

bool is_road(const Row& row) {
    return row.interval.kind == IntervalKind::road;
}

Cell way_of(const Row& row) {
    return is_road(row) ? Cell{way_of(row.roads, row.interval.edge).id} : Cell{};
}

Cell node_of(const Row& row, bool at_start) {
    return is_road(row) ? Cell{end_node_id(row.roads, row.interval.edge, at_start)} : Cell{};
}

Cell direction_of(const Row& row) {
    return is_road(row) ? Cell{is_forward(row.interval.edge) ? "forward" : "backward"} : Cell{};
}

/// Distance of an end along the way; from_m < to_m in either direction.
Cell along_way_of(const Row& row, bool is_first) {
    const auto& [interval, roads] = row;
    if (!is_road(row)) {
        return {};
    }
    const double a_m = along_way_m(roads, interval.edge, interval.from_offset_m);
    const double b_m = along_way_m(roads, interval.edge, interval.to_offset_m);
    return is_first ? std::min(a_m, b_m) : std::max(a_m, b_m);
}

// clang-format off
const Columns<Row> road_columns{
    {"way_id", as::integer, [](auto& r) { return way_of(r); }},
    {"from_node", as::integer, [](auto& r) { return node_of(r, true); }},
    {"to_node", as::integer, [](auto& r) { return node_of(r, false); }},
    {"direction", as::text, direction_of},
    {"from_m", as::metres(2), [](auto& r) { return along_way_of(r, true); }},
    {"to_m", as::metres(2), [](auto& r) { return along_way_of(r, false); }},
    {"offset_sd_m", as::json_only(as::metres(2)), [](auto& r) { return r.interval.offset_sd_m; }},
};
const Columns<Row> interval_columns{
    {"t_enter_s", as::seconds(3), [](auto& r) { return r.interval.t_enter_s; }},
    {"t_leave_s", as::seconds(3), [](auto& r) { return r.interval.t_leave_s; }},
    {"confidence", as::real(4), [](auto& r) { return r.interval.confidence; }},
    {"kind", as::text, [](auto& r) { return kind_name(r.interval.kind); }},
    {"reason", as::text, [](auto& r) { return r.interval.reason; }},
};
const Columns<Arc> arc_columns{
    {"from_node", as::integer, [](auto& r) { return r.from_node; }},
    {"to_node", as::integer, [](auto& r) { return r.to_node; }},
    {"way_id", as::integer, [](auto& r) { return r.way_id; }},
    {"t_enter_s", as::seconds(3), [](auto& r) { return r.t_enter_s; }},
};
// clang-format on

/// Columns of an interval on a road; others lack the first of them in GeoJSON.
Columns<Row> all_columns(UnitSystem units) {
    auto columns = road_columns;
    columns.insert(columns.end(), interval_columns.begin(), interval_columns.end());
    return in_units(columns, units);
}

/// Returns the part of an edge that an interval covers.
std::vector<GeoPoint> line_of_piece(const MatchedInterval& piece, const RoadNetwork& roads) {
    std::vector<GeoPoint> line{place_on(roads, piece.edge, piece.from_offset_m)};
    double offset_m = 0;
    const auto whole = line_of(roads, piece.edge);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        offset_m += i == 0 ? 0 : distance_m(whole[i - 1], whole[i]);
        if (offset_m > piece.from_offset_m && offset_m < piece.to_offset_m) {
            line.push_back(whole[i]);
        }
    }
    line.push_back(place_on(roads, piece.edge, piece.to_offset_m));
    return line;
}

std::string feature_of(const Row& row, const Columns<Row>& columns) {
    return is_road(row) ? geojson_feature(
                              {}, line_of_piece(row.interval, row.roads), json_object(columns, row))
                        : geojson_feature({}, {}, json_object(interval_columns, row));
}

std::vector<Row> rows_of(const MatchedTrace& traversals, const RoadNetwork& roads) {
    std::vector<Row> rows;
    for (const auto& interval : traversals) {
        rows.push_back({interval, roads});
    }
    return rows;
}

/// Returns the length within an interval that was not driven, because the recording was paused and
/// the positions jumped.
double paused_within_m(const MatchedInterval& piece, const Odometer& odometer) {
    double paused_m = 0;
    for (const auto& pause : odometer.pauses()) {
        paused_m += std::max(0.0,
                             std::min(pause.to_m, piece.to_travel_m) -
                                 std::max(pause.from_m, piece.from_travel_m));
    }
    return paused_m;
}

} // namespace

std::string traversals_text(const MatchedTrace& traversals,
                            const RoadNetwork& roads,
                            std::string_view format,
                            UnitSystem units) {
    const auto columns = all_columns(units);
    return rows_text(columns, rows_of(traversals, roads), format, [&](const Row& row) {
        return feature_of(row, columns);
    });
}

std::string
arcs_text(const MatchedTrace& trace, const RoadNetwork& roads, std::string_view format) {
    return rows_text(arc_columns, arcs_of(trace, roads), format);
}

std::string matched_words(const MatchedTrace& trace, const Odometer& odometer, UnitSystem units) {
    double on_m = 0;
    double off_m = 0;
    double gap_m = 0;
    double sure_m = 0;
    for (const auto& piece : trace) {
        auto& sum_m = piece.kind == IntervalKind::road  ? on_m
                      : piece.kind == IntervalKind::gap ? gap_m
                                                        : off_m;
        const double long_m =
            piece.to_travel_m - piece.from_travel_m - paused_within_m(piece, odometer);
        sum_m += long_m;
        sure_m += piece.confidence * long_m;
    }
    return fmt::format("{} on roads{}, {} off the network, {} in gaps",
                       km_words(on_m / 1000, 2, units),
                       on_m > 0 ? fmt::format(" (confidence {:.2f})", sure_m / on_m) : "",
                       km_words(off_m / 1000, 2, units),
                       km_words(gap_m / 1000, 2, units));
}

} // namespace macadam
