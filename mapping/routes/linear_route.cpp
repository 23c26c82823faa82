#include "mapping/routes/linear_route.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/road_strokes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace macadam {
namespace {

constexpr double a_millimetre_m = 1e-3;  // resolution of the network's lengths
constexpr double sharpest_turn_deg = 60; // into another way, as in worst_sections

double length_m(const RouteEdge& part) {
    return part.to_m - part.from_m;
}

std::uint32_t number_of_way(const RoadNetwork& roads, std::int64_t way_id) {
    const auto ways = roads.ways.first(way_count(roads));
    const auto found = std::ranges::lower_bound(ways, way_id, {}, &PackedWay::id);
    if (found == ways.end() || found->id != way_id) {
        throw InputError{fmt::format("the network has no way '{}'", way_id)};
    }
    return static_cast<std::uint32_t>(found - ways.begin());
}

/// Reverses a route.
LinearRoute turned_round(const LinearRoute& road, const RoadNetwork& roads) {
    LinearRoute back;
    for (auto part = road.parts.rbegin(); part != road.parts.rend(); ++part) {
        if (!part->edge) {
            back.parts.push_back(*part);
            continue;
        }
        const double whole_m = macadam::length_m(roads, *part->edge);
        back.parts.push_back({reversed(*part->edge), whole_m - part->to_m, whole_m - part->from_m});
    }
    return back;
}

LinearRoute whole_of(const RoadNetwork& roads, std::span<const EdgeId> edges) {
    LinearRoute road;
    for (const auto edge : edges) {
        road.parts.push_back({edge, 0, macadam::length_m(roads, edge)});
    }
    return road;
}

double drawn_so_m(const RoadNetwork& roads, const std::vector<EdgeId>& chain) {
    double sum_m = 0;
    for (const auto edge : chain) {
        sum_m += is_forward(edge) ? macadam::length_m(roads, edge) : 0;
    }
    return sum_m;
}

std::vector<bool> edges_named(const RoadNetwork& roads, std::string_view name) {
    std::vector<bool> wanted(std::size_t{2} * link_count(roads), false);
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        const auto way = way_at(roads, i);
        for (auto link = way.first_link; way.name == name && link < way.past_link; ++link) {
            for (const bool forward : {true, false}) {
                const auto edge = edge_of(LinkId{link}, forward);
                wanted[static_cast<std::uint32_t>(edge)] = is_drivable(roads, edge);
            }
        }
    }
    return wanted;
}

/// Returns the segment of an edge that contains an offset, counted in driving direction.
std::uint32_t segment_at(const Link& link, double segment_m, double offset_m) {
    const double last = link.segments - 1;
    const bool has_length = segment_m > 0; // two points near a pole may coincide
    return static_cast<std::uint32_t>(has_length ? std::clamp(offset_m / segment_m, 0.0, last)
                                                 : 0.0);
}

void add_pieces(std::vector<RouteSegment>& pieces,
                const RoadNetwork& roads,
                const RouteEdge& part,
                double start_m) {
    const auto link = link_at(roads, *part.edge);
    const bool forward = is_forward(*part.edge);
    const auto way_id = roads.ways[link.way].id;
    const double segment_m = (link.to_m - link.from_m) / link.segments;
    const double ruler_m = start_m - part.from_m; // measure at the start of the edge
    const auto last = segment_at(link, segment_m, part.to_m - a_millimetre_m);
    for (auto i = segment_at(link, segment_m, part.from_m + a_millimetre_m); i <= last; ++i) {
        const double from_m = std::max(part.from_m, i * segment_m);
        const double to_m = std::min(part.to_m, (i + 1) * segment_m);
        const auto along = forward ? i : link.segments - 1 - i;
        pieces.push_back({.segment = SegmentKey{way_id, forward, link.first_segment + along},
                          .from_m = ruler_m + from_m,
                          .to_m = ruler_m + to_m,
                          .segment_middle_m = ruler_m + (i + 0.5) * segment_m,
                          .way_from_m = forward ? link.from_m + from_m : link.to_m - to_m,
                          .way_to_m = forward ? link.from_m + to_m : link.to_m - from_m});
    }
}

/// Extends a range by an adjacent segment at either end; returns true if the range contains the
/// segment.
bool joins(SegmentRange& range, const SegmentKey& key) {
    if (range.way_id != key.way_id || range.forward != key.forward) {
        return false;
    }
    if (key.index + 1 == range.first) {
        range.first = key.index;
    } else if (key.index == range.past) {
        range.past = key.index + 1;
    }
    return range.first <= key.index && key.index < range.past;
}

} // namespace

double length_m(const LinearRoute& road) {
    double sum_m = 0;
    for (const auto& part : road.parts) {
        sum_m += length_m(part);
    }
    return sum_m;
}

LinearRoute followed(const MatchedTrace& trace) {
    LinearRoute road;
    for (const auto& piece : trace) {
        const bool on_road = piece.kind == IntervalKind::road;
        auto part = on_road ? RouteEdge{piece.edge, piece.from_offset_m, piece.to_offset_m}
                            : RouteEdge{{}, 0, piece.to_travel_m - piece.from_travel_m};
        auto* const last = road.parts.empty() ? nullptr : &road.parts.back();
        const bool goes_on = last != nullptr && last->edge && last->edge == part.edge &&
                             std::abs(last->to_m - part.from_m) < a_millimetre_m;
        if (goes_on) {
            last->to_m = part.to_m;
        } else if (length_m(part) > a_millimetre_m) {
            road.parts.push_back(part);
        }
    }
    return road;
}

LinearRoute route_along_way(const RoadNetwork& roads,
                            std::int64_t way_id,
                            std::optional<double> from_m,
                            std::optional<double> to_m,
                            std::optional<bool> forward) {
    const auto way = way_at(roads, number_of_way(roads, way_id));
    std::vector<EdgeId> edges;
    for (auto link = way.first_link; link < way.past_link; ++link) {
        edges.push_back(edge_of(LinkId{link}, true));
    }
    const auto whole = whole_of(roads, edges);
    const bool onward = forward.value_or(from_m.value_or(0) <= to_m.value_or(length_m(whole)));
    const double begin_m = from_m.value_or(onward ? 0 : length_m(whole));
    const double end_m = to_m.value_or(onward ? length_m(whole) : 0);
    if (onward != (begin_m <= end_m)) {
        return part_of(whole, roads, end_m, begin_m);
    }
    return part_of(whole, roads, begin_m, end_m);
}

LinearRoute route_of_named_road(const RoadNetwork& roads, std::string_view name) {
    std::map<LinkId, std::vector<EdgeId>> roads_of_name; // by their lowest link: both directions
    for (const auto& chain : road_strokes(roads, edges_named(roads, name), sharpest_turn_deg)) {
        const auto lowest = link_of(*std::ranges::min_element(chain));
        auto& best = roads_of_name[lowest];
        if (best.empty() || drawn_so_m(roads, chain) > drawn_so_m(roads, best)) {
            best = chain;
        }
    }
    if (roads_of_name.size() != 1) {
        throw InputError{
            roads_of_name.empty()
                ? fmt::format("the network has no road '{}'", name)
                : fmt::format("'{}' names {} separate roads in the network, expected one: give "
                              "it by way_id or as a line",
                              name,
                              roads_of_name.size())};
    }
    return whole_of(roads, roads_of_name.begin()->second);
}

LinearRoute part_of(const LinearRoute& road, const RoadNetwork& roads, double from_m, double to_m) {
    const double low_m = std::min(from_m, to_m), high_m = std::max(from_m, to_m);
    LinearRoute part;
    double start_m = 0;
    for (const auto& whole : road.parts) {
        const double end_m = start_m + length_m(whole);
        const double begin_m = std::max(low_m, start_m), stop_m = std::min(high_m, end_m);
        if (stop_m - begin_m > a_millimetre_m) {
            part.parts.push_back({whole.edge,
                                  whole.from_m + (begin_m - start_m),
                                  whole.from_m + (stop_m - start_m)});
        }
        start_m = end_m;
    }
    return from_m <= to_m ? part : turned_round(part, roads);
}

std::vector<RouteSegment> pieces_of(const RoadNetwork& roads, const LinearRoute& road) {
    std::vector<RouteSegment> pieces;
    double start_m = 0;
    for (const auto& part : road.parts) {
        if (part.edge) {
            add_pieces(pieces, roads, part, start_m);
        } else {
            pieces.push_back({.segment = {},
                              .from_m = start_m,
                              .to_m = start_m + length_m(part),
                              .segment_middle_m = start_m + length_m(part) / 2,
                              .way_from_m = 0,
                              .way_to_m = 0});
        }
        start_m += length_m(part);
    }
    return pieces;
}

std::vector<SegmentRange> ranges_of(const std::vector<RouteSegment>& pieces) {
    std::vector<SegmentRange> ranges;
    for (const auto& piece : pieces) {
        if (const auto& key = piece.segment;
            key && (ranges.empty() || !joins(ranges.back(), *key))) {
            ranges.push_back({key->way_id, key->forward, key->index, key->index + 1});
        }
    }
    return ranges;
}

std::vector<GeoPoint>
line_of(const RoadNetwork& roads, const LinearRoute& road, double from_m, double to_m) {
    std::vector<GeoPoint> line;
    for (const auto& part : part_of(road, roads, from_m, to_m).parts) {
        for (const auto& point : part.edge ? line_on(roads, *part.edge, part.from_m, part.to_m)
                                           : std::vector<GeoPoint>{}) {
            if (line.empty() || distance_m(line.back(), point) > a_millimetre_m) {
                line.push_back(point);
            }
        }
    }
    return line;
}

} // namespace macadam
