#include "storage/networks/background/sea_assembly.hpp"

#include "mapping/geometry/line_clipping.hpp"
#include "mapping/geometry/rings_around.hpp"
#include "storage/networks/osm_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr double max_inset = 0.25;    // of the bounds' width, from their edge to the end of a coast
constexpr double min_remainder = 0.5; // of the bounds' width, if coasts end inside of them

using Spot = RingPoint;
using Line = std::vector<Spot>; // in units of 1e-7 degrees

Spot spot_of(const PackedPoint& point) {
    return {double(point.lon_e7), double(point.lat_e7)};
}

ClipBox clip_box(const GeoBox& box) {
    const auto e7 = [](double deg) { return std::round(deg * Unpacked::per_deg); };
    return {e7(box.west_deg), e7(box.south_deg), e7(box.east_deg), e7(box.north_deg)};
}

std::vector<PackedPoint> packed_ring(const Line& line) {
    std::vector<PackedPoint> ring;
    ring.reserve(line.size());
    for (const auto& [x, y] : line) {
        const PackedPoint point{std::int32_t(std::lround(y)), std::int32_t(std::lround(x))};
        if (ring.empty() || ring.back() != point) {
            ring.push_back(point);
        }
    }
    while (ring.size() > 1 && ring.back() == ring.front()) {
        ring.pop_back();
    }
    return ring;
}

/// Twice the area of a ring; positive if it runs counterclockwise, with its inside on the left.
double twice_area(const Line& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto& a = ring[i];
        const auto& b = ring[(i + 1) % ring.size()];
        sum += (a.x - ring[0].x) * (b.y - ring[0].y) - (b.x - ring[0].x) * (a.y - ring[0].y);
    }
    return sum;
}

// ----------------------------------------------------------------------------------------- chains

/// Coastlines joined end to end.
struct Chains {
    std::vector<Line> open, rings; ///< of rings, the first point is not repeated
};

/// Returns the parts of ways between points that are missing, each of two or more.
std::vector<PlacedWay> without_gaps(std::span<const PlacedWay> ways) {
    std::vector<PlacedWay> parts;
    for (const auto& way : ways) {
        PlacedWay part{way.id, {}, {}};
        for (std::size_t i = 0; i <= way.nodes.size(); ++i) {
            if (i < way.nodes.size() && way.points[i] != NodePositions::nowhere) {
                part.nodes.push_back(way.nodes[i]);
                part.points.push_back(way.points[i]);
                continue;
            }
            if (part.nodes.size() > 1) {
                parts.push_back(part);
            }
            part.nodes.clear();
            part.points.clear();
        }
    }
    return parts;
}

Chains chains_of(std::span<const PlacedWay> coast) {
    std::set<std::pair<std::int64_t, std::size_t>> waiting; // by first node
    std::set<std::int64_t> ends;
    for (std::size_t i = 0; i < coast.size(); ++i) {
        waiting.emplace(coast[i].nodes.front(), i);
        ends.insert(coast[i].nodes.back());
    }
    Chains chains;
    const auto follow = [&](std::size_t first) {
        Line line{spot_of(coast[first].points.front())};
        const auto start = coast[first].nodes.front();
        auto end = start;
        for (auto way = waiting.find({start, first}); way != waiting.end() && way->first == end;) {
            const auto& [id, nodes, points] = coast[way->second];
            waiting.erase(way);
            std::transform(points.begin() + 1, points.end(), std::back_inserter(line), spot_of);
            end = nodes.back();
            way = end == start ? waiting.end() : waiting.lower_bound({end, 0});
        }
        if (end == start) {
            line.pop_back();
            chains.rings.push_back(std::move(line));
        } else {
            chains.open.push_back(std::move(line));
        }
    };
    for (std::size_t i = 0; i < coast.size(); ++i) {
        if (!ends.contains(coast[i].nodes.front())) {
            follow(i);
        }
    }
    while (!waiting.empty()) {
        follow(waiting.begin()->second);
    }
    return chains;
}

// ----------------------------------------------------------------------------------------- border

bool is_inside(const Spot& spot, const ClipBox& box) {
    return box.low_x < spot.x && spot.x < box.high_x && box.low_y < spot.y && spot.y < box.high_y;
}

/// Moves the sides of a box to the ends of lines inside of it. \returns false if they lie too deep.
bool cut_at_ends(const std::vector<Line>& lines, ClipBox& box) {
    const auto whole = box;
    const double width = whole.high_x - whole.low_x;
    const double height = whole.high_y - whole.low_y;
    for (const auto& line : lines) {
        for (const auto& end : {line.front(), line.back()}) {
            if (!is_inside(end, box)) {
                continue;
            }
            const std::array depths{(end.x - whole.low_x) / width,
                                    (whole.high_x - end.x) / width,
                                    (end.y - whole.low_y) / height,
                                    (whole.high_y - end.y) / height};
            const auto least = std::ranges::min_element(depths);
            if (*least > max_inset) {
                return false;
            }
            const auto side = least - depths.begin();
            (side == 0   ? box.low_x
             : side == 1 ? box.high_x
             : side == 2 ? box.low_y
                         : box.high_y) = side < 2 ? end.x : end.y;
        }
    }
    return box.high_x - box.low_x >= min_remainder * width &&
           box.high_y - box.low_y >= min_remainder * height;
}

/// Course of the border of a box, clockwise from its north-west corner; a side counts 1.
class Border {
public:
    Border(const ClipBox& box, const ClipBox& room) : box_{box}, room_{room} {}

    double course_of(const Spot& spot) const {
        const double east = (spot.x - box_.low_x) / (box_.high_x - box_.low_x);
        const double north = (spot.y - box_.low_y) / (box_.high_y - box_.low_y);
        const std::array distances{1 - north, 1 - east, north, east};
        const auto side = std::ranges::min_element(distances) - distances.begin();
        const double along = side == 0   ? east
                             : side == 1 ? 1 - north
                             : side == 2 ? 1 - east
                                         : north;
        return double(side) + std::clamp(along, 0.0, 1.0);
    }

    /// Appends the way from one course to another along the border of the room, clockwise; nothing
    /// for a short way along one side, on which the sea ends.
    void append(Line& line, double from, double to) const {
        constexpr double min_width = 0.25; // of the side: narrower water would go on as a stripe
        const double end = to < from ? to + 4 : to;
        if (std::floor(from) == std::floor(end) && end - from < min_width) {
            return;
        }
        line.push_back(outside(from));
        for (double corner = std::floor(from) + 1; corner < end; ++corner) {
            line.push_back(corner_of(int(corner) % 4));
        }
        line.push_back(outside(to));
    }

    /// Returns the whole room, clockwise.
    Line whole() const { return {corner_of(0), corner_of(1), corner_of(2), corner_of(3)}; }

private:
    /// Foot of a point of the border on that of the room.
    Spot outside(double course) const {
        const double along = course - std::floor(course);
        const double x = box_.low_x + along * (box_.high_x - box_.low_x);
        const double back_x = box_.high_x - along * (box_.high_x - box_.low_x);
        const double y = box_.low_y + along * (box_.high_y - box_.low_y);
        const double back_y = box_.high_y - along * (box_.high_y - box_.low_y);
        switch (int(course) % 4) {
        case 0:
            return {x, room_.high_y};
        case 1:
            return {room_.high_x, back_y};
        case 2:
            return {back_x, room_.low_y};
        default:
            return {room_.low_x, y};
        }
    }

    Spot corner_of(int side) const {
        return {side == 0 || side == 3 ? room_.low_x : room_.high_x,
                side < 2 ? room_.high_y : room_.low_y};
    }

    ClipBox box_, room_;
};

/// Parts of coastlines within a box.
struct Clipped {
    std::vector<Line> crossing; ///< from border to border
    std::vector<Line> rings;
};

void clip_line(const Line& line, const ClipBox& box, std::vector<Line>& pieces) {
    const auto at = [](const Spot& a, const Spot& b, double part) {
        return part == 0   ? a
               : part == 1 ? b
                           : Spot{a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
    };
    bool goes_on = false;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const auto part = clipped_line(line[i], line[i + 1], box);
        if (part.from >= part.to) {
            goes_on = false;
            continue;
        }
        if (!goes_on || part.from > 0) {
            pieces.push_back({at(line[i], line[i + 1], part.from)});
        }
        pieces.back().push_back(at(line[i], line[i + 1], part.to));
        goes_on = part.to == 1;
    }
}

Clipped clipped(const Chains& chains, const ClipBox& box) {
    Clipped parts;
    for (const auto& line : chains.open) {
        clip_line(line, box, parts.crossing);
    }
    const auto is_outside = [&](const Spot& spot) {
        return spot.x < box.low_x || spot.x > box.high_x || spot.y < box.low_y ||
               spot.y > box.high_y;
    };
    for (auto ring : chains.rings) {
        const auto first = std::ranges::find_if(ring, is_outside);
        if (first == ring.end()) {
            parts.rings.push_back(std::move(ring));
            continue;
        }
        std::rotate(ring.begin(), first, ring.end());
        ring.push_back(ring.front());
        clip_line(ring, box, parts.crossing);
    }
    return parts;
}

bool meets(const Chains& chains, const ClipBox& box) {
    return std::ranges::any_of(chains.open, [&](const Line& line) {
        return std::ranges::any_of(line, [&](const Spot& spot) { return is_inside(spot, box); });
    });
}

/// Joins pieces along the border: from the end of each on to the start of the next, clockwise,
/// since the sea is on its right. `std::nullopt` if two starts or two ends follow each other.
std::optional<std::vector<Line>> joined_along(const Border& border, std::vector<Line> pieces) {
    struct Event {
        double course;
        bool is_start;
        std::size_t piece;
    };
    std::vector<Event> events;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        events.push_back({border.course_of(pieces[i].front()), true, i});
        events.push_back({border.course_of(pieces[i].back()), false, i});
    }
    std::ranges::sort(events, {}, [](const Event& event) {
        return std::tuple{event.course, event.is_start, event.piece};
    });
    struct Next {
        std::size_t piece;
        double from, to;
    };
    std::vector<Next> next(pieces.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        const auto& event = events[i];
        const auto& after = events[(i + 1) % events.size()];
        if (event.is_start == after.is_start) {
            return {};
        }
        if (!event.is_start) {
            next[event.piece] = {after.piece, event.course, after.course};
        }
    }
    std::vector<Line> rings;
    std::vector<bool> taken(pieces.size(), false);
    for (std::size_t first = 0; first < pieces.size(); ++first) {
        Line ring;
        for (std::size_t at = first; !taken[at]; at = next[at].piece) {
            taken[at] = true;
            ring.insert(ring.end(), pieces[at].begin(), pieces[at].end());
            border.append(ring, next[at].from, next[at].to);
        }
        if (!ring.empty()) {
            rings.push_back(std::move(ring));
        }
    }
    return rings;
}

} // namespace

Sea assemble_sea(std::span<const PlacedWay> coast, const GeoBox& bounds, const GeoBox& room) {
    const Sea broken{.areas = {}, .is_broken = true};
    auto box = clip_box(bounds);
    const auto chains = chains_of(without_gaps(coast));
    if (coast.empty() || box.low_x >= box.high_x || box.low_y >= box.high_y) {
        return {};
    }
    if (!cut_at_ends(chains.open, box)) {
        return broken;
    }
    auto around = clip_box(room);
    around = {std::min(around.low_x, box.low_x),
              std::min(around.low_y, box.low_y),
              std::max(around.high_x, box.high_x),
              std::max(around.high_y, box.high_y)};
    const Border border{box, around};
    auto parts = clipped(chains, box);
    const bool is_crossed = !parts.crossing.empty();
    if (!is_crossed && parts.rings.empty() && meets(chains, clip_box(bounds))) {
        return broken; // the ends of coasts have cut all of them off
    }
    auto outer = joined_along(border, std::move(parts.crossing));
    if (!outer) {
        return broken;
    }
    std::vector<Line> islands;
    for (auto& ring : parts.rings) {
        (twice_area(ring) > 0 ? islands : *outer).push_back(std::move(ring));
    }
    std::vector<Spot> spots;
    for (const auto& island : islands) {
        spots.push_back(island.front());
    }
    auto area_of = rings_around(*outer, spots);
    if (!area_of) {
        return broken;
    }
    if (!is_crossed && std::ranges::find(*area_of, outer->size()) != area_of->end()) {
        outer->push_back(border.whole()); // around islands alone
    }
    Sea sea;
    sea.areas.resize(outer->size());
    for (std::size_t i = 0; i < outer->size(); ++i) {
        sea.areas[i].push_back(packed_ring((*outer)[i]));
    }
    for (std::size_t i = 0; i < islands.size(); ++i) {
        auto ring = packed_ring(islands[i]);
        if ((*area_of)[i] < sea.areas.size() && ring.size() >= 3) {
            sea.areas[(*area_of)[i]].push_back(std::move(ring));
        }
    }
    std::erase_if(sea.areas, [](const auto& rings) { return rings.front().size() < 3; });
    return sea;
}

} // namespace macadam
