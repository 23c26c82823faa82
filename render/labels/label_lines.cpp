#include "render/labels/label_lines.hpp"

#include "mapping/geometry/line_clipping.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr double min_cosine = 0.5; // of the turn between two parts: 60 degrees
constexpr std::size_t nothing = SIZE_MAX;

bool stands_before(const PixelPoint& a, const PixelPoint& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
}

bool line_before(const std::vector<PixelPoint>& a, const std::vector<PixelPoint>& b) {
    return std::ranges::lexicographical_compare(a, b, stands_before);
}

/// Returns the line in pixels from the cell's corner.
std::vector<PixelPoint> line_in_cell(const RoadName& road, const PixelBox& cell) {
    std::vector<PixelPoint> line;
    line.reserve(road.line.size());
    for (const auto& point : road.line) {
        line.push_back({point.x - cell.left, point.y - cell.top});
    }
    return line;
}

PixelPoint between(const PixelPoint& a, const PixelPoint& b, double part) {
    if (part == 0) {
        return a;
    }
    return part == 1 ? b : PixelPoint{a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
}

struct Piece {
    PixelPoint from, to;
    bool reaches_to; ///< includes the end of the original line segment
};

/// Returns the remainder of a line segment; the points are the same in either direction.
std::optional<Piece> cut_piece(const PixelPoint& from, const PixelPoint& to, const PixelBox& room) {
    const bool turned = stands_before(to, from);
    const auto& a = turned ? to : from;
    const auto& b = turned ? from : to;
    const auto cut = clipped_line(a, b, {room.left, room.top, room.right, room.bottom});
    const auto first = between(a, b, cut.from);
    const auto last = between(a, b, cut.to);
    if (!(cut.from < cut.to) || first == last) {
        return {};
    }
    return turned ? Piece{last, first, cut.from == 0} : Piece{first, last, cut.to == 1};
}

/// Returns the parts of a line inside a box.
std::vector<std::vector<PixelPoint>> inside(const std::vector<PixelPoint>& line,
                                            const PixelBox& room) {
    std::vector<std::vector<PixelPoint>> parts;
    bool goes_on = false;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        if (line[i] == line[i + 1]) {
            continue;
        }
        const auto piece = cut_piece(line[i], line[i + 1], room);
        if (piece) {
            if (!goes_on) {
                parts.push_back({piece->from});
            }
            parts.back().push_back(piece->to);
        }
        goes_on = piece && piece->reaches_to;
    }
    return parts;
}

/// Returns the line in the direction that sorts first.
std::vector<PixelPoint> directed(std::vector<PixelPoint> line) {
    std::vector<PixelPoint> back{line.rbegin(), line.rend()};
    return line_before(back, line) ? back : line;
}

bool may_touch(const RoadName& road, const PixelBox& cell) {
    PixelBox box{1, 1, -1, -1};
    for (std::size_t i = 0; i < road.line.size(); ++i) {
        const auto& point = road.line[i];
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
            return false;
        }
        box = i == 0 ? PixelBox{point.x, point.y, point.x, point.y}
                     : PixelBox{std::min(box.left, point.x),
                                std::min(box.top, point.y),
                                std::max(box.right, point.x),
                                std::max(box.bottom, point.y)};
    }
    return road.line.size() >= 2 && box.left <= cell.right && cell.left <= box.right &&
           box.top <= cell.bottom && cell.top <= box.bottom;
}

bool part_before(const NamedPart& a, const NamedPart& b) {
    if (a.name != b.name) {
        return a.name < b.name;
    }
    if (a.line != b.line) {
        return line_before(a.line, b.line);
    }
    return std::tuple{a.quiet, a.rank, -a.half_width_px} <
           std::tuple{b.quiet, b.rank, -b.half_width_px};
}

// ---------------------------------------------------------------------------------------- joining

struct Arm {
    std::size_t part;
    bool at_end;     ///< of the part's line
    PixelPoint away; ///< direction from the position, of length 1
};

PixelPoint unit_step(const PixelPoint& from, const PixelPoint& to) {
    const double x = to.x - from.x;
    const double y = to.y - from.y;
    const double length = std::sqrt(x * x + y * y);
    return {x / length, y / length};
}

/// Rounds a point to a grid of a sixteenth of a pixel: ends in the same cell are joined.
std::pair<std::int64_t, std::int64_t> place_of(const PixelPoint& point) {
    return {std::llround(point.x * 16), std::llround(point.y * 16)};
}

using ArmsByPoint = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<Arm>>;

ArmsByPoint places_of(std::span<const NamedPart> parts) {
    ArmsByPoint places;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto& line = parts[i].line;
        places[place_of(line.front())].push_back({i, false, unit_step(line.front(), line[1])});
        places[place_of(line.back())].push_back(
            {i, true, unit_step(line.back(), line[line.size() - 2])});
    }
    return places;
}

struct Joint {
    double cosine;
    std::size_t a, b; ///< indices of the position's arms
};

/// Continuations of each part at its start and its end: the other part and whether at its end.
using Partners = std::vector<std::array<std::pair<std::size_t, bool>, 2>>;

void join_at(const std::vector<Arm>& arms, Partners& partners) {
    std::vector<Joint> joints;
    for (std::size_t a = 0; a < arms.size(); ++a) {
        for (std::size_t b = a + 1; b < arms.size(); ++b) {
            const double cosine =
                -(arms[a].away.x * arms[b].away.x + arms[a].away.y * arms[b].away.y);
            if (arms[a].part != arms[b].part && cosine >= min_cosine) {
                joints.push_back({cosine, a, b});
            }
        }
    }
    std::ranges::stable_sort(joints, std::ranges::greater{}, &Joint::cosine);
    for (const auto& [cosine, a, b] : joints) {
        auto& from = partners[arms[a].part][arms[a].at_end ? 1 : 0];
        auto& to = partners[arms[b].part][arms[b].at_end ? 1 : 0];
        if (from.first == nothing && to.first == nothing) {
            from = {arms[b].part, arms[b].at_end};
            to = {arms[a].part, arms[a].at_end};
        }
    }
}

Partners partners_of(std::span<const NamedPart> parts) {
    Partners partners(parts.size(), {std::pair{nothing, false}, std::pair{nothing, false}});
    for (const auto& [place, arms] : places_of(parts)) {
        join_at(arms, partners);
    }
    return partners;
}

void append(NamedPart& chain, const NamedPart& part, bool backwards) {
    auto line = part.line;
    if (backwards) {
        std::ranges::reverse(line);
    }
    chain.line.insert(chain.line.end(), line.begin() + (chain.line.empty() ? 0 : 1), line.end());
    chain.rank = std::min(chain.rank, part.rank);
    chain.quiet = chain.quiet && part.quiet;
    chain.half_width_px = std::max(chain.half_width_px, part.half_width_px);
}

/// Joins the parts of one name.
std::vector<NamedPart> chains_of(std::span<const NamedPart> parts) {
    const auto partners = partners_of(parts);
    std::vector<bool> taken(parts.size(), false);
    std::vector<NamedPart> chains;
    const auto follow = [&](std::size_t start, bool backwards) {
        auto chain = parts[start];
        chain.line.clear();
        for (std::size_t at = start; at != nothing && !taken[at];) {
            taken[at] = true;
            append(chain, parts[at], backwards);
            const auto [next, at_end] = partners[at][backwards ? 0 : 1];
            at = next;
            backwards = at_end;
        }
        chains.push_back(std::move(chain));
    };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const bool starts = partners[i][0].first == nothing;
        const bool ends = partners[i][1].first == nothing;
        if (!taken[i] && (starts || ends)) {
            follow(i, !starts);
        }
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!taken[i]) {
            follow(i, false); // rings have no start
        }
    }
    return chains;
}

} // namespace

std::vector<NamedPart> parts_in(std::span<const RoadName> roads, const PixelBox& cell) {
    const PixelBox room{0, 0, cell.width(), cell.height()};
    std::vector<NamedPart> parts;
    for (const auto& road : roads) {
        if (!may_touch(road, cell)) {
            continue;
        }
        for (auto& line : inside(line_in_cell(road, cell), room)) {
            parts.push_back(
                {directed(std::move(line)), road.name, road.rank, road.quiet, road.half_width_px});
        }
    }
    std::ranges::sort(parts, part_before);
    const auto twins = std::ranges::unique(parts, [](const NamedPart& a, const NamedPart& b) {
        return a.name == b.name && a.line == b.line;
    });
    parts.erase(twins.begin(), twins.end());
    return parts;
}

std::vector<NamedPart> named_chains(const std::vector<NamedPart>& parts) {
    std::vector<NamedPart> chains;
    for (std::size_t first = 0; first < parts.size();) {
        std::size_t last = first;
        while (last < parts.size() && parts[last].name == parts[first].name) {
            ++last;
        }
        if (!parts[first].name.empty()) {
            auto found = chains_of(std::span{parts}.subspan(first, last - first));
            std::ranges::move(found, std::back_inserter(chains));
        }
        first = last;
    }
    return chains;
}

std::vector<JunctionCore> junction_cores(std::span<const NamedPart> parts) {
    std::vector<JunctionCore> cores;
    for (const auto& [place, arms] : places_of(parts)) {
        if (arms.size() < 3) {
            continue;
        }
        const auto& [part, at_end, away] = arms.front();
        JunctionCore core{at_end ? parts[part].line.back() : parts[part].line.front(), 0};
        for (const auto& arm : arms) {
            core.radius_px = std::max(core.radius_px, parts[arm.part].half_width_px);
        }
        cores.push_back(core);
    }
    return cores;
}

double length_px(std::span<const PixelPoint> line) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double x = line[i + 1].x - line[i].x;
        const double y = line[i + 1].y - line[i].y;
        length += std::sqrt(x * x + y * y);
    }
    return length;
}

} // namespace macadam
