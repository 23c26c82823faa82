#include "app/trace/match_output.hpp"

#include "mapping/matching/arcs.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
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

/// Matched interval in output columns; from_m < to_m along the way in either direction.
struct RoadCells {
    std::int64_t way_id;
    std::int64_t from_node;
    std::int64_t to_node;
    std::string_view direction;
    double from_m;
    double to_m;
};

RoadCells road_cells(const MatchedInterval& piece, const RoadNetwork& roads) {
    const double a_m = along_way_m(roads, piece.edge, piece.from_offset_m);
    const double b_m = along_way_m(roads, piece.edge, piece.to_offset_m);
    return {.way_id = way_of(roads, piece.edge).id,
            .from_node = end_node_id(roads, piece.edge, true),
            .to_node = end_node_id(roads, piece.edge, false),
            .direction = is_forward(piece.edge) ? "forward" : "backward",
            .from_m = std::min(a_m, b_m),
            .to_m = std::max(a_m, b_m)};
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

std::string coordinates(const std::vector<GeoPoint>& line) {
    std::vector<std::string> points;
    points.reserve(line.size());
    for (const auto& point : line) {
        points.push_back(fmt::format("[{:.7f},{:.7f}]", point.lon_deg, point.lat_deg));
    }
    return json_array(points);
}

std::string geojson_feature(const MatchedInterval& piece, const RoadNetwork& roads) {
    JsonObject properties;
    JsonValue geometry = nullptr;
    if (piece.kind == IntervalKind::road) {
        const auto cells = road_cells(piece, roads);
        properties.add("way_id", cells.way_id)
            .add("from_node", cells.from_node)
            .add("to_node", cells.to_node)
            .add("direction", std::string{cells.direction})
            .add("from_m", JsonNumber{cells.from_m, 2})
            .add("to_m", JsonNumber{cells.to_m, 2})
            .add("offset_sd_m", JsonNumber{piece.offset_sd_m, 2});
        JsonObject line;
        line.add("type", std::string{"LineString"})
            .add("coordinates", JsonRaw{coordinates(line_of_piece(piece, roads))});
        geometry = JsonRaw{line.text()};
    }
    properties.add("t_enter_s", JsonNumber{piece.t_enter_s, 3})
        .add("t_leave_s", JsonNumber{piece.t_leave_s, 3})
        .add("confidence", JsonNumber{piece.confidence, 4})
        .add("kind", std::string{kind_name(piece.kind)})
        .add("reason", piece.reason);
    JsonObject feature;
    feature.add("type", std::string{"Feature"})
        .add("geometry", geometry)
        .add("properties", JsonRaw{properties.text()});
    return feature.text();
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

std::string passages_csv(const MatchedTrace& passages, const RoadNetwork& roads) {
    std::string csv = "way_id,from_node,to_node,direction,from_m,to_m,t_enter_s,t_leave_s,"
                      "confidence,kind,reason\n";
    for (const auto& piece : passages) {
        if (piece.kind == IntervalKind::road) {
            const auto cells = road_cells(piece, roads);
            csv += fmt::format("{},{},{},{},{:.2f},{:.2f}",
                               cells.way_id,
                               cells.from_node,
                               cells.to_node,
                               cells.direction,
                               cells.from_m,
                               cells.to_m);
        } else {
            csv += ",,,,,";
        }
        csv += fmt::format(",{:.3f},{:.3f},{:.4f},{},{}\n",
                           piece.t_enter_s,
                           piece.t_leave_s,
                           piece.confidence,
                           kind_name(piece.kind),
                           piece.reason);
    }
    return csv;
}

std::string passages_geojson(const MatchedTrace& passages, const RoadNetwork& roads) {
    std::vector<std::string> features;
    features.reserve(passages.size());
    for (const auto& piece : passages) {
        features.push_back(geojson_feature(piece, roads));
    }
    JsonObject collection;
    collection.add("type", std::string{"FeatureCollection"})
        .add("features", JsonRaw{json_array(features)});
    return collection.text() + "\n";
}

std::string arcs_csv(const MatchedTrace& trace, const RoadNetwork& roads) {
    std::string csv = "from_node,to_node,way_id,t_enter_s\n";
    for (const auto& arc : arcs_of(trace, roads)) {
        csv +=
            fmt::format("{},{},{},{:.3f}\n", arc.from_node, arc.to_node, arc.way_id, arc.t_enter_s);
    }
    return csv;
}

std::string matched_words(const MatchedTrace& trace, const Odometer& odometer) {
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
    return fmt::format("{:.2f} km on roads{}, {:.2f} km off the network, {:.2f} km in gaps",
                       on_m / 1000,
                       on_m > 0 ? fmt::format(" (confidence {:.2f})", sure_m / on_m) : "",
                       off_m / 1000,
                       gap_m / 1000);
}

} // namespace macadam
