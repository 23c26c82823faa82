
#include "mapping/network/build_network.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/network_arrays.hpp"
#include "mapping/network/speed_limits.hpp"
#include "mapping/network/turn_restrictions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace macadam {
namespace {

// ---------------------------------------------------------------------------------------- ways

/// Removes consecutive repeats of a point, which maps contain now and then.
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
        return packed(point) != packed(way.line.front());
    });
}

/// Sorts ways by id and keeps those that form a line.
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
            fmt::format("way '{}' occurs twice in the network, expected once", twice->id)};
    }
    return ways;
}

/// Rejects ways near the antimeridian: where longitudes jump from 180 to -180, lines, boxes and
/// plane coordinates are invalid.
void expect_on_globe(const std::vector<Way>& ways) {
    for (const auto& way : ways) {
        for (const auto& point : way.line) {
            if (!(std::abs(point.lat_deg) <= 90 && std::isfinite(point.lon_deg))) {
                throw InputError{fmt::format("way '{}' has the invalid position {:g}, {:g}",
                                             way.id,
                                             point.lat_deg,
                                             point.lon_deg)};
            }
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

/// Interns strings.
class TextPool {
public:
    TextPool(NetworkArrays& tables, const NetworkLimits& limits)
        : tables_{tables}, max_letters_{limits.letters} {
        tables_.first_letter = {0};
    }

    std::uint32_t number_of(const std::string& text) {
        const auto [found, fresh] =
            numbers_.try_emplace(text, static_cast<std::uint32_t>(numbers_.size()));
        if (fresh) {
            if (tables_.letters.size() + text.size() >= max_letters_) {
                throw InputError{
                    fmt::format("the names of the roads are too long for one network: they have "
                                "{} bytes or more, expected fewer",
                                max_letters_)};
            }
            tables_.letters.insert(tables_.letters.end(), text.begin(), text.end());
            tables_.first_letter.push_back(static_cast<std::uint32_t>(tables_.letters.size()));
        }
        return found->second;
    }

private:
    NetworkArrays& tables_;
    std::uint64_t max_letters_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

void add_lengths(NetworkArrays& tables, const Way& way) {
    constexpr double longest_m = std::numeric_limits<std::uint32_t>::max() / Unpacked::per_m;
    const std::span points{tables.points.end() - static_cast<std::ptrdiff_t>(way.line.size()),
                           tables.points.end()};
    double along_m = 0;
    tables.along_mm.push_back(0);
    for (std::size_t i = 1; i < points.size(); ++i) {
        along_m += distance_m(Unpacked{}(points[i - 1]), Unpacked{}(points[i]));
        if (!(along_m < longest_m)) {
            throw InputError{fmt::format(
                "way '{}' is longer than {:.0f} km, expected a road", way.id, longest_m / 1000)};
        }
        tables.along_mm.push_back(
            static_cast<std::uint32_t>(std::lround(along_m * Unpacked::per_m)));
    }
}

/// Adds the records of the ways with their points, and an end sentinel. Frees each way once added,
/// because the map of a country has millions. Links are added later.
void add_ways(NetworkArrays& tables, std::vector<Way> ways, const NetworkLimits& limits) {
    TextPool texts{tables, limits};
    const auto start = [&] {
        return PackedWay{.id = 0,
                         .first_point = static_cast<std::uint32_t>(tables.points.size()),
                         .first_link = 0,
                         .first_turn = static_cast<std::uint32_t>(tables.turns.size()),
                         .name = 0,
                         .highway = 0,
                         .speed_limit_cmps = 0,
                         .oneway = 0,
                         .zero = 0};
    };
    for (auto& taken : ways) {
        const auto way = std::move(taken);
        auto record = start();
        record.id = way.id;
        record.name = texts.number_of(way.name);
        record.highway = texts.number_of(way.highway);
        record.speed_limit_cmps = way.speed_limit_cmps;
        record.oneway = static_cast<std::uint8_t>(way.oneway);
        tables.ways.push_back(record);
        std::transform(way.line.begin(), way.line.end(), std::back_inserter(tables.points), packed);
        tables.node_ids.insert(tables.node_ids.end(), way.node_ids.begin(), way.node_ids.end());
        tables.turns.insert(tables.turns.end(), way.turns.begin(), way.turns.end());
        add_lengths(tables, way);
    }
    tables.ways.push_back(start());
}

// ------------------------------------------------------------------------------------ topology

/// Returns the ids of the points that are nodes, ascending: ends of ways and points that occur more
/// than once.
std::vector<std::int64_t> node_identities(const NetworkArrays& tables) {
    auto met = tables.node_ids;
    for (std::size_t way = 0; way + 1 < tables.ways.size(); ++way) {
        met.push_back(tables.node_ids[tables.ways[way].first_point]); // an end counts twice
        met.push_back(tables.node_ids[tables.ways[way + 1].first_point - 1]);
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

std::string_view text(const NetworkArrays& tables, std::uint32_t number) {
    const auto first = tables.first_letter[number];
    return {tables.letters.data() + first, tables.first_letter[number + 1] - first};
}

std::uint16_t speed_limit_cmps(const NetworkArrays& tables, const PackedWay& way) {
    return way.speed_limit_cmps > 0 ? way.speed_limit_cmps
                                    : usual_speed_limit_cmps(text(tables, way.highway));
}

/// Adds the way's links in its own direction. \returns their number of segments.
std::uint64_t add_links(NetworkArrays& tables,
                        std::uint32_t way,
                        const std::vector<std::int64_t>& nodes,
                        double segment_length_m) {
    std::uint64_t segments = 0;
    const auto& record = tables.ways[way];
    PackedLink link{.way = way,
                    .from = *number_of_node(nodes, tables.node_ids[record.first_point]),
                    .to = 0,
                    .first_point = record.first_point,
                    .first_segment = 0,
                    .length_mm = 0,
                    .speed_limit_cmps = speed_limit_cmps(tables, record),
                    .flags = flags_of(static_cast<Oneway>(record.oneway))};
    for (auto i = record.first_point + 1; i < tables.ways[way + 1].first_point; ++i) {
        const auto node = number_of_node(nodes, tables.node_ids[i]);
        if (!node) {
            continue;
        }
        link.to = *node;
        link.length_mm = tables.along_mm[i] - tables.along_mm[link.first_point];
        tables.links.push_back(link);
        tables.node_point[link.from] = link.first_point;
        tables.node_point[link.to] = i;
        link.from = link.to;
        link.first_point = i;
        segments += segments_in(Unpacked{}(link.length_mm), segment_length_m);
        link.first_segment = static_cast<std::uint32_t>(segments); // the caller checks its range
    }
    return segments;
}

[[noreturn]] void refuse_segments(std::size_t points, double segment_length_m, std::uint64_t most) {
    throw InputError{fmt::format("the roads are too long for their {} points: they have more than "
                                 "{} segments of {:g} m; expected coordinates of real roads, or a "
                                 "longer segment length",
                                 points,
                                 most,
                                 segment_length_m)};
}

void add_links(NetworkArrays& tables,
               const std::vector<std::int64_t>& nodes,
               double segment_length_m,
               const NetworkLimits& limits) {
    tables.node_point.resize(nodes.size());
    const auto past = static_cast<std::uint32_t>(tables.ways.size() - 1);
    const auto most = max_segments(tables.points.size(), limits);
    std::uint64_t segments = 0;
    for (std::uint32_t way = 0; way < past; ++way) {
        tables.ways[way].first_link = static_cast<std::uint32_t>(tables.links.size());
        const auto of_way = add_links(tables, way, nodes, segment_length_m);
        segments += of_way;
        if (segments > most || of_way > std::numeric_limits<std::uint32_t>::max()) {
            refuse_segments(tables.points.size(), segment_length_m, most);
        }
    }
    tables.ways[past].first_link = static_cast<std::uint32_t>(tables.links.size());
    tables.links.push_back({.way = past,
                            .from = 0,
                            .to = 0,
                            .first_point = static_cast<std::uint32_t>(tables.points.size()),
                            .first_segment = 0,
                            .length_mm = 0,
                            .speed_limit_cmps = 0,
                            .flags = 0});
}

/// Calls `visit(node, edge)` for every drivable edge, in the order of the edges.
template <typename Visit>
void for_each_departure(const NetworkArrays& tables, Visit visit) {
    for (std::uint32_t i = 0; i + 1 < tables.links.size(); ++i) {
        const auto& link = tables.links[i];
        if ((link.flags & link_flags::forward) != 0) {
            visit(link.from, edge_of(LinkId{i}, true));
        }
        if ((link.flags & link_flags::backward) != 0) {
            visit(link.to, edge_of(LinkId{i}, false));
        }
    }
}

void add_departures(NetworkArrays& tables) {
    auto& first = tables.first_out;
    first.assign(tables.node_point.size() + 1, 0);
    for_each_departure(tables, [&](std::uint32_t node, EdgeId) { ++first[node + 1]; });
    for (std::size_t i = 1; i < first.size(); ++i) {
        first[i] += first[i - 1];
    }
    tables.out_edges.resize(first.back());
    auto next = first;
    for_each_departure(
        tables, [&](std::uint32_t node, EdgeId edge) { tables.out_edges[next[node]++] = edge; });
}

// --------------------------------------------------------------------------------------- index

GridBox box_of(std::span<const PackedPoint> points) {
    GridBox box{points[0].lat_e7, points[0].lon_e7, points[0].lat_e7, points[0].lon_e7};
    for (const auto& point : points) {
        box = {std::min(box.south_e7, point.lat_e7),
               std::min(box.west_e7, point.lon_e7),
               std::max(box.north_e7, point.lat_e7),
               std::max(box.east_e7, point.lon_e7)};
    }
    return box;
}

BoxTreeArrays tree_of(const NetworkArrays& tables) {
    std::vector<GridBox> boxes;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i + 1 < tables.links.size(); ++i) {
        const auto& link = tables.links[i];
        const auto& next = tables.links[i + 1];
        const auto last =
            next.way == link.way ? next.first_point : tables.ways[link.way + 1].first_point - 1;
        const auto pieces = pieces_of(last - link.first_point);
        // 64 bits: for a link of 262,144 points, steps times boxes exceed 2^32.
        const std::uint64_t steps = last - link.first_point;
        for (std::uint64_t piece = 0; piece < pieces; ++piece) {
            const auto from = link.first_point + steps * piece / pieces;
            const auto to = link.first_point + steps * (piece + 1) / pieces;
            boxes.push_back(box_of(std::span{tables.points}.subspan(from, to - from + 1)));
            numbers.push_back(i);
        }
    }
    return build_box_tree(std::move(boxes), std::move(numbers));
}

void expect_to_be_numbered(const std::vector<Way>& ways, const NetworkLimits& limits) {
    std::uint64_t points = 0;
    std::uint64_t turns = 0;
    for (const auto& way : ways) {
        points += way.line.size();
        turns += way.turns.size();
    }
    if (points >= limits.points) {
        throw InputError{
            fmt::format("the roads have {} points, expected fewer than {}", points, limits.points)};
    }
    if (turns >= limits.turns) {
        throw InputError{fmt::format(
            "the roads have {} turn restrictions, expected fewer than {}", turns, limits.turns)};
    }
}

} // namespace

RoadNetwork build_network(std::vector<Way> ways, double segment_length_m) {
    return build_network(std::move(ways), segment_length_m, NetworkLimits{});
}

RoadNetwork
build_network(std::vector<Way> ways, double segment_length_m, const NetworkLimits& limits) {
    if (!(segment_length_m > 0) || !std::isfinite(segment_length_m)) {
        throw InputError{
            fmt::format("segment length '{}', expected metres above 0", segment_length_m)};
    }
    auto ordered = in_order(std::move(ways));
    expect_on_globe(ordered);
    expect_to_be_numbered(ordered, limits);
    const auto tables = std::make_shared<NetworkArrays>();
    add_ways(*tables, std::move(ordered), limits);
    const auto nodes = node_identities(*tables);
    add_links(*tables, nodes, segment_length_m, limits);
    add_departures(*tables);
    add_turn_restrictions(*tables, nodes);
    tables->tree = tree_of(*tables);
    return {.owner = tables,
            .segment_length_m = segment_length_m,
            .ways = tables->ways,
            .points = tables->points,
            .node_ids = tables->node_ids,
            .along_mm = tables->along_mm,
            .links = tables->links,
            .node_point = tables->node_point,
            .first_out = tables->first_out,
            .out_edges = tables->out_edges,
            .turn_restrictions = tables->turn_restrictions,
            .turns = tables->turns,
            .tree = {tables->tree.boxes, tables->tree.numbers},
            .first_letter = tables->first_letter,
            .letters = tables->letters};
}

} // namespace macadam
