#include "mapping/network/road_strokes.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace macadam {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double along_the_way = -1; // preferred to any turn into another way

std::uint32_t number_of(EdgeId edge) {
    return static_cast<std::uint32_t>(edge);
}

double course_at_start_deg(const RoadNetwork& roads, EdgeId edge) {
    const auto link = link_at(roads, edge);
    const auto line = way_of(roads, edge).line;
    return is_forward(edge) ? course_deg(line[link.first_point], line[link.first_point + 1])
                            : course_deg(line[link.last_point], line[link.last_point - 1]);
}

double course_at_end_deg(const RoadNetwork& roads, EdgeId edge) {
    return std::fmod(course_at_start_deg(roads, reversed(edge)) + 180, 360);
}

bool is_next_of_way(const RoadNetwork& roads, EdgeId edge, EdgeId next) {
    const auto forward = is_forward(edge);
    return link_at(roads, edge).way == link_at(roads, next).way && forward == is_forward(next) &&
           number_of(next) == (forward ? number_of(edge) + 2 : number_of(edge) - 2);
}

bool is_same_road(const WayView& a, const WayView& b) {
    return a.name == b.name && (!a.name.empty() || a.highway == b.highway);
}

/// Returns the turn from an edge to the next; `std::nullopt` if that is another road.
std::optional<double>
turn_deg(const RoadNetwork& roads, EdgeId edge, EdgeId next, double sharpest_turn_deg) {
    if (is_next_of_way(roads, edge, next)) {
        return along_the_way;
    }
    if (next == reversed(edge) || !is_same_road(way_of(roads, edge), way_of(roads, next))) {
        return std::nullopt;
    }
    const double turn = std::abs(
        std::remainder(course_at_start_deg(roads, next) - course_at_end_deg(roads, edge), 360));
    return turn <= sharpest_turn_deg ? std::optional{turn} : std::nullopt;
}

struct Choice {
    std::uint32_t edge = none;
    double turn_deg = std::numeric_limits<double>::infinity();
};

/// Returns the successor of each edge where both prefer each other.
std::vector<std::uint32_t>
next_edges(const RoadNetwork& roads, const std::vector<bool>& wanted, double sharpest_turn_deg) {
    std::vector<Choice> after(wanted.size()), before(wanted.size());
    const auto offer = [](Choice& choice, EdgeId edge, double turn) {
        if (turn < choice.turn_deg) {
            choice = {number_of(edge), turn};
        }
    };
    for (std::uint32_t i = 0; i < wanted.size(); ++i) {
        if (!wanted[i]) {
            continue;
        }
        const EdgeId edge{i};
        for (const auto next : out_edges(roads, to_node(roads, edge))) {
            const auto turn = wanted[number_of(next)]
                                  ? turn_deg(roads, edge, next, sharpest_turn_deg)
                                  : std::nullopt;
            if (turn) {
                offer(after[i], next, *turn);
                offer(before[number_of(next)], edge, *turn);
            }
        }
    }
    std::vector<std::uint32_t> next(wanted.size(), none);
    for (std::uint32_t i = 0; i < wanted.size(); ++i) {
        if (after[i].edge != none && before[after[i].edge].edge == i) {
            next[i] = after[i].edge;
        }
    }
    return next;
}

} // namespace

std::vector<std::vector<EdgeId>>
road_strokes(const RoadNetwork& roads, const std::vector<bool>& wanted, double sharpest_turn_deg) {
    assert(wanted.size() == std::size_t{2} * link_count(roads));
    const auto next = next_edges(roads, wanted, sharpest_turn_deg);
    std::vector<bool> is_first = wanted;
    for (const auto edge : next) {
        if (edge != none) {
            is_first[edge] = false;
        }
    }
    std::vector<bool> done(wanted.size(), false);
    std::vector<std::vector<EdgeId>> chains;
    const auto follow = [&](std::uint32_t first) {
        auto& chain = chains.emplace_back();
        for (auto i = first; i != none && !done[i]; i = next[i]) {
            done[i] = true;
            chain.push_back(EdgeId{i});
        }
    };
    for (std::uint32_t i = 0; i < wanted.size(); ++i) {
        if (is_first[i]) {
            follow(i);
        }
    }
    for (std::uint32_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i] && !done[i]) {
            follow(i);
        }
    }
    return chains;
}

} // namespace macadam
