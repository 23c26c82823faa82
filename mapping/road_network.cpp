#include "mapping/road_network.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double cell_deg = 0.00225; // 250 m of latitude: a few links a cell in a town

// ---------------------------------------------------------------------------------------- ways

/// Without repeats of one and the same point in sequence, which maps hold now and then.
Way without_repeats(Way way) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < way.node_ids.size(); ++i) {
        if (i > 0 && way.node_ids[i] == way.node_ids[kept - 1]) {
            continue;
        }
        way.node_ids[kept] = way.node_ids[i];
        way.line[kept] = way.line[i];
        ++kept;
    }
    way.node_ids.resize(kept);
    way.line.resize(kept);
    return way;
}

bool is_a_line(const Way& way) {
    return std::any_of(way.line.begin(), way.line.end(), [&](const GeoPoint& point) {
        return point != way.line.front();
    });
}

/// In the order of their ids, each a line.
std::vector<Way> in_order(std::vector<Way> ways) {
    for (auto& way : ways) {
        assert(way.node_ids.size() == way.line.size());
        way = without_repeats(std::move(way));
    }
    std::erase_if(ways, [](const Way& way) { return !is_a_line(way); });
    std::sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.id < b.id; });
    const auto twice = std::adjacent_find(
        ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.id == b.id; });
    if (twice != ways.end()) {
        throw InputError{
            fmt::format("way '{}' stands twice in the network, expected each id once", twice->id)};
    }
    return ways;
}

/// Where longitudes jump from 180 to -180 neither lines nor boxes nor plane metres hold.
void expect_away_from_antimeridian(const std::vector<Way>& ways) {
    constexpr double farthest_lon_deg = 179.9; // 11 km of room at the equator
    for (const auto& way : ways) {
        for (const auto& point : way.line) {
            if (std::abs(point.lon_deg) > farthest_lon_deg) {
                throw InputError{fmt::format("way '{}' reaches longitude {:g}, expected roads at "
                                             "least {:.1f} degrees from the antimeridian",
                                             way.id,
                                             point.lon_deg,
                                             180 - farthest_lon_deg)};
            }
        }
    }
}

std::vector<double> distances_along(const std::vector<GeoPoint>& line) {
    std::vector<double> along_m(line.size(), 0.0);
    for (std::size_t i = 1; i < line.size(); ++i) {
        along_m[i] = along_m[i - 1] + distance_m(line[i - 1], line[i]);
    }
    return along_m;
}

// ------------------------------------------------------------------------------------ topology

/// Identities of the points that are nodes, rising: ends of ways and points met more than once.
std::vector<std::int64_t> node_identities(const std::vector<Way>& ways) {
    std::vector<std::int64_t> met;
    for (const auto& way : ways) {
        met.insert(met.end(), way.node_ids.begin(), way.node_ids.end());
        met.push_back(way.node_ids.front()); // an end counts as met twice
        met.push_back(way.node_ids.back());
    }
    std::sort(met.begin(), met.end());
    std::vector<std::int64_t> nodes;
    for (std::size_t i = 1; i < met.size(); ++i) {
        if (met[i] == met[i - 1] && (nodes.empty() || nodes.back() != met[i])) {
            nodes.push_back(met[i]);
        }
    }
    return nodes;
}

struct Topology {
    std::vector<std::int64_t> identities; ///< by NodeId, rising

    bool is_node(std::int64_t id) const {
        return std::binary_search(identities.begin(), identities.end(), id);
    }
    NodeId operator[](std::int64_t id) const {
        const auto found = std::lower_bound(identities.begin(), identities.end(), id);
        return NodeId{static_cast<std::uint32_t>(found - identities.begin())};
    }
};

std::uint32_t segments_in(double link_m, double segment_length_m) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(link_m / segment_length_m)));
}

/// The way's parts between nodes, in its own direction.
std::vector<Link> links_of(const Way& way,
                           std::uint32_t way_index,
                           const std::vector<double>& along_m,
                           const Topology& topology,
                           double segment_length_m) {
    std::vector<Link> links;
    std::uint32_t first = 0;
    std::uint32_t segment = 0;
    for (std::uint32_t i = 1; i < way.node_ids.size(); ++i) {
        if (!topology.is_node(way.node_ids[i])) {
            continue;
        }
        const auto segments = segments_in(along_m[i] - along_m[first], segment_length_m);
        links.push_back({.way = way_index,
                         .from = topology[way.node_ids[first]],
                         .to = topology[way.node_ids[i]],
                         .first_point = first,
                         .last_point = i,
                         .from_m = along_m[first],
                         .to_m = along_m[i],
                         .forward = way.oneway != Oneway::backward,
                         .backward = way.oneway != Oneway::forward,
                         .first_segment = segment,
                         .segments = segments});
        segment += segments;
        first = i;
    }
    return links;
}

std::vector<GeoPoint>
places_of_nodes(const std::vector<Way>& ways, const std::vector<Link>& links, std::size_t count) {
    std::vector<GeoPoint> places(count);
    for (const auto& link : links) {
        places[static_cast<std::uint32_t>(link.from)] = ways[link.way].line[link.first_point];
        places[static_cast<std::uint32_t>(link.to)] = ways[link.way].line[link.last_point];
    }
    return places;
}

/// Calls `visit(node, edge)` for every drivable edge, in the order of the edges.
template <typename Visit>
void for_each_departure(const std::vector<Link>& links, Visit visit) {
    for (std::uint32_t i = 0; i < links.size(); ++i) {
        if (links[i].forward) {
            visit(static_cast<std::uint32_t>(links[i].from), edge_of(LinkId{i}, true));
        }
        if (links[i].backward) {
            visit(static_cast<std::uint32_t>(links[i].to), edge_of(LinkId{i}, false));
        }
    }
}

std::vector<std::uint32_t> first_departures(const std::vector<Link>& links, std::size_t nodes) {
    std::vector<std::uint32_t> first(nodes + 1, 0);
    for_each_departure(links, [&](std::uint32_t node, EdgeId) { ++first[node + 1]; });
    for (std::size_t i = 1; i < first.size(); ++i) {
        first[i] += first[i - 1];
    }
    return first;
}

std::vector<EdgeId> departures(const std::vector<Link>& links, std::vector<std::uint32_t> next) {
    std::vector<EdgeId> edges(next.back());
    for_each_departure(links, [&](std::uint32_t node, EdgeId edge) { edges[next[node]++] = edge; });
    return edges;
}

// --------------------------------------------------------------------------------------- index

std::uint64_t row_at(double lat_deg) {
    return static_cast<std::uint64_t>(std::max(0.0, (lat_deg + 90) / cell_deg));
}

std::uint64_t column_at(double lon_deg) {
    return static_cast<std::uint64_t>(std::max(0.0, (lon_deg + 180) / cell_deg));
}

constexpr std::uint64_t cell_at(std::uint64_t row, std::uint64_t column) {
    return row << 32U | column;
}

/// Cells that the straight line from `a` to `b` touches, and perhaps a neighbour of theirs. A line
/// over the antimeridian, where there are no roads to speak of, touches the whole way round.
void add_cells(std::vector<std::uint64_t>& cells, GeoPoint a, GeoPoint b) {
    constexpr double slack_deg = 1e-9; // 0.1 mm: rounding must not lose a cell
    if (a.lat_deg > b.lat_deg) {
        std::swap(a, b);
    }
    const double rise_deg = b.lat_deg - a.lat_deg;
    const auto lon_at = [&](double lat_deg) {
        return rise_deg > 0 ? std::lerp(a.lon_deg,
                                        b.lon_deg,
                                        std::clamp((lat_deg - a.lat_deg) / rise_deg, 0.0, 1.0))
                            : a.lon_deg;
    };
    const auto last_row = row_at(b.lat_deg + slack_deg);
    for (auto row = row_at(a.lat_deg - slack_deg); row <= last_row; ++row) {
        const double south_deg = static_cast<double>(row) * cell_deg - 90;
        const double enter_deg = lon_at(south_deg);
        const double leave_deg = rise_deg > 0 ? lon_at(south_deg + cell_deg) : b.lon_deg;
        const auto last_column = column_at(std::max(enter_deg, leave_deg) + slack_deg);
        for (auto column = column_at(std::min(enter_deg, leave_deg) - slack_deg);
             column <= last_column;
             ++column) {
            cells.push_back(cell_at(row, column));
        }
    }
}

std::vector<RoadNetwork::CellEntry> index_of(const std::vector<Way>& ways,
                                             const std::vector<Link>& links) {
    std::vector<RoadNetwork::CellEntry> entries;
    std::vector<std::uint64_t> touched;
    for (std::uint32_t i = 0; i < links.size(); ++i) {
        const auto& line = ways[links[i].way].line;
        touched.clear();
        for (auto point = links[i].first_point; point < links[i].last_point; ++point) {
            add_cells(touched, line[point], line[point + 1]);
        }
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        for (const auto cell : touched) {
            entries.push_back({cell, LinkId{i}});
        }
    }
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
        return std::pair{a.cell, a.link} < std::pair{b.cell, b.link};
    });
    entries.shrink_to_fit();
    return entries;
}

const Link& link_at(const RoadNetwork& roads, EdgeId edge) {
    return roads.links[static_cast<std::uint32_t>(link_of(edge))];
}

} // namespace

RoadNetwork build_network(std::vector<Way> ways, double segment_length_m) {
    if (!(segment_length_m > 0) || !std::isfinite(segment_length_m)) {
        throw InputError{
            fmt::format("segment length '{}', expected metres above 0", segment_length_m)};
    }
    RoadNetwork roads;
    roads.segment_length_m = segment_length_m;
    roads.ways = in_order(std::move(ways));
    expect_away_from_antimeridian(roads.ways);
    const Topology topology{node_identities(roads.ways)};
    for (std::uint32_t i = 0; i < roads.ways.size(); ++i) {
        roads.way_point_m.push_back(distances_along(roads.ways[i].line));
        const auto links =
            links_of(roads.ways[i], i, roads.way_point_m[i], topology, segment_length_m);
        roads.links.insert(roads.links.end(), links.begin(), links.end());
    }
    roads.nodes = places_of_nodes(roads.ways, roads.links, topology.identities.size());
    roads.out_first = first_departures(roads.links, roads.nodes.size());
    roads.out_edges = departures(roads.links, roads.out_first);
    roads.cells = index_of(roads.ways, roads.links);
    return roads;
}

std::span<const EdgeId> out_edges(const RoadNetwork& roads, NodeId node) {
    const auto index = static_cast<std::uint32_t>(node);
    const auto first = roads.out_first[index];
    return std::span{roads.out_edges}.subspan(first, roads.out_first[index + 1] - first);
}

bool is_drivable(const RoadNetwork& roads, EdgeId edge) {
    return is_forward(edge) ? link_at(roads, edge).forward : link_at(roads, edge).backward;
}

NodeId from_node(const RoadNetwork& roads, EdgeId edge) {
    return is_forward(edge) ? link_at(roads, edge).from : link_at(roads, edge).to;
}

NodeId to_node(const RoadNetwork& roads, EdgeId edge) {
    return from_node(roads, reversed(edge));
}

double length_m(const RoadNetwork& roads, LinkId link) {
    const auto& found = roads.links[static_cast<std::uint32_t>(link)];
    return found.to_m - found.from_m;
}

double length_m(const RoadNetwork& roads, EdgeId edge) {
    return length_m(roads, link_of(edge));
}

std::vector<GeoPoint> line_of(const RoadNetwork& roads, EdgeId edge) {
    const auto& link = link_at(roads, edge);
    const auto first = roads.ways[link.way].line.begin();
    std::vector<GeoPoint> line(first + link.first_point, first + link.last_point + 1);
    if (!is_forward(edge)) {
        std::reverse(line.begin(), line.end());
    }
    return line;
}

GeoPoint place_on(const RoadNetwork& roads, EdgeId edge, double offset_m) {
    const auto& link = link_at(roads, edge);
    const auto& line = roads.ways[link.way].line;
    const auto& along_m = roads.way_point_m[link.way];
    const double at_m = std::clamp(
        is_forward(edge) ? link.from_m + offset_m : link.to_m - offset_m, link.from_m, link.to_m);
    const auto next = std::upper_bound(
        along_m.begin() + link.first_point + 1, along_m.begin() + link.last_point, at_m);
    const auto i = static_cast<std::size_t>(next - along_m.begin());
    const double step_m = along_m[i] - along_m[i - 1];
    return between(line[i - 1], line[i], step_m > 0 ? (at_m - along_m[i - 1]) / step_m : 0.0);
}

std::vector<LinkId> links_near(const RoadNetwork& roads, const GeoBox& box) {
    std::vector<LinkId> links;
    if (is_empty(box) || roads.cells.empty()) {
        return links;
    }
    const auto first_row = std::max(row_at(box.south_deg), roads.cells.front().cell >> 32U);
    const auto last_row = std::min(row_at(box.north_deg), roads.cells.back().cell >> 32U);
    const auto last_column = column_at(box.east_deg);
    auto entry = roads.cells.begin();
    for (auto row = first_row; row <= last_row; ++row) {
        // The columns of a row stand one after the other.
        entry = std::lower_bound(entry,
                                 roads.cells.end(),
                                 cell_at(row, column_at(box.west_deg)),
                                 [](const auto& a, std::uint64_t cell) { return a.cell < cell; });
        for (; entry != roads.cells.end() && entry->cell <= cell_at(row, last_column); ++entry) {
            links.push_back(entry->link);
        }
    }
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
    return links;
}

GeoBox extent_of(const RoadNetwork& roads) {
    GeoBox box;
    for (const auto& way : roads.ways) {
        for (const auto& point : way.line) {
            box = including(box, point);
        }
    }
    return box;
}

} // namespace macadam
