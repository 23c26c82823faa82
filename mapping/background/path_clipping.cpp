#include "mapping/background/path_clipping.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

using Path = CellPath;

/// Point of the straight line a-b at `at` of an axis. Both tiles that meet there get the same one.
CellPoint
crossing(const CellPoint& a, const CellPoint& b, std::int32_t CellPoint::*axis, std::int32_t at) {
    const auto other = axis == &CellPoint::x ? &CellPoint::y : &CellPoint::x;
    const auto& [low, high] = a.*axis < b.*axis ? std::pair{a, b} : std::pair{b, a};
    const double share = double(at - low.*axis) / (double(high.*axis) - low.*axis);
    CellPoint point{};
    point.*axis = at;
    point.*other = low.*other + static_cast<std::int32_t>(
                                    std::lround(share * (double(high.*other) - low.*other)));
    return point;
}

/// Part of a ring on the kept side of a border, from where it comes in to where it goes out.
using Chain = Path;

/// Splits a ring into its chains; empty if it lies on one side. Points on the border are inside.
std::vector<Chain> chains_of(const Path& ring,
                             std::int32_t CellPoint::*axis,
                             std::int32_t border,
                             const std::vector<bool>& inside) {
    std::vector<Chain> chains;
    const auto first =
        static_cast<std::size_t>(std::find(inside.begin(), inside.end(), false) - inside.begin());
    for (std::size_t step = 0; step < ring.size(); ++step) { // from a point outside
        const auto i = (first + step) % ring.size();
        const auto j = (i + 1) % ring.size();
        if (!inside[i] && inside[j]) {
            chains.emplace_back();
            if (ring[j].*axis != border) {
                chains.back().push_back(crossing(ring[i], ring[j], axis, border));
            }
        }
        if (inside[j]) {
            chains.back().push_back(ring[j]);
        } else if (inside[i] && ring[i].*axis != border) {
            chains.back().push_back(crossing(ring[i], ring[j], axis, border));
        }
    }
    std::erase_if(chains, [](const Chain& chain) { return chain.size() < 2; }); // touches
    return chains;
}

/// Joins chains along the border into rings: there, the area lies between each pair of neighbouring
/// ends. Ends that are not in turn, of rings that cross, are joined as they come.
void append_joined(std::vector<Path>& rings,
                   std::vector<Chain> chains,
                   std::int32_t CellPoint::*along) {
    struct End {
        std::int32_t at;
        std::size_t chain;
        bool comes_in;
    };
    std::vector<End> ends;
    for (std::size_t i = 0; i < chains.size(); ++i) {
        ends.push_back({chains[i].front().*along, i, true});
        ends.push_back({chains[i].back().*along, i, false});
    }
    std::stable_sort(
        ends.begin(), ends.end(), [](const End& a, const End& b) { return a.at < b.at; });
    std::vector<std::size_t> next(chains.size());
    bool in_turn = true;
    for (std::size_t i = 0; i < ends.size(); i += 2) {
        in_turn = in_turn && ends[i].comes_in != ends[i + 1].comes_in;
        const auto& [out, in] =
            ends[i].comes_in ? std::pair{ends[i + 1], ends[i]} : std::pair{ends[i], ends[i + 1]};
        next[out.chain] = in.chain;
    }
    std::vector<bool> done(chains.size(), false);
    for (std::size_t i = 0; i < chains.size(); ++i) {
        Path ring;
        for (auto at = i; !done[at]; at = in_turn ? next[at] : at) {
            done[at] = true;
            ring.insert(ring.end(), chains[at].begin(), chains[at].end());
        }
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        if (ring.size() > 1 && ring.front() == ring.back()) {
            ring.pop_back();
        }
        if (ring.size() > 2) {
            rings.push_back(std::move(ring));
        }
    }
}

/// Cuts rings at one border. What is left has no edge to and fro along it.
///
/// Source: K. Weiler and P. Atherton, "Hidden surface removal using polygon area sorting", Computer
/// Graphics 11 (1977), pp. 214-222, for a half-plane.
std::vector<Path> rings_within(const std::vector<Path>& rings,
                               std::int32_t CellPoint::*axis,
                               std::int32_t border,
                               bool keeps_above) {
    std::vector<Path> kept;
    std::vector<Chain> chains;
    for (const auto& ring : rings) {
        std::vector<bool> inside;
        std::size_t count = 0;
        for (const auto& point : ring) {
            inside.push_back(keeps_above ? point.*axis >= border : point.*axis <= border);
            count += inside.back() ? 1 : 0;
        }
        if (count == ring.size()) {
            kept.push_back(ring);
        } else if (count > 0) {
            auto more = chains_of(ring, axis, border, inside);
            std::move(more.begin(), more.end(), std::back_inserter(chains));
        }
    }
    append_joined(kept, std::move(chains), axis == &CellPoint::x ? &CellPoint::y : &CellPoint::x);
    return kept;
}

bool is_around(const Path& ring, const CellPoint& point) {
    bool inside = false;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const auto& a = ring[i];
        const auto& b = ring[j];
        if ((a.y > point.y) != (b.y > point.y) &&
            point.x < double(b.x - a.x) * (point.y - a.y) / double(b.y - a.y) + a.x) {
            inside = !inside;
        }
    }
    return inside;
}

/// Cuts lines at the two borders of a strip into their parts within it.
std::vector<Path> lines_between(const std::vector<Path>& lines,
                                std::int32_t CellPoint::*axis,
                                std::int32_t low,
                                std::int32_t high) {
    std::vector<Path> parts;
    for (const auto& line : lines) {
        Path part;
        const auto end_part = [&] {
            if (part.size() > 1) {
                parts.push_back(part);
            }
            part.clear();
        };
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            auto a = line[i];
            auto b = line[i + 1];
            if (std::max(a.*axis, b.*axis) < low || std::min(a.*axis, b.*axis) > high) {
                end_part();
                continue;
            }
            for (auto* const end : {&a, &b}) {
                if (const auto border = std::clamp(end->*axis, low, high); border != end->*axis) {
                    *end = crossing(line[i], line[i + 1], axis, border);
                }
            }
            if (part.empty() || part.back() != a) {
                end_part();
                part.push_back(a);
            }
            if (part.back() != b) {
                part.push_back(b);
            }
        }
        end_part();
    }
    return parts;
}

} // namespace

double twice_area(const Path& ring) {
    double sum = 0; // exact within a tile

    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto& a = ring[i];
        const auto& b = ring[i + 1 < ring.size() ? i + 1 : 0];
        sum += (double(a.x) - ring[0].x) * (double(b.y) - ring[0].y) -
               (double(b.x) - ring[0].x) * (double(a.y) - ring[0].y);
    }
    return sum;
}

std::vector<Path> rings_in_order(std::vector<Path> rings) {
    std::vector<std::vector<Path>> groups;
    std::vector<Path> holes;
    for (auto& ring : rings) {
        if (const double area = twice_area(ring); area > 0) {
            groups.emplace_back().push_back(std::move(ring));
        } else if (area < 0) {
            holes.push_back(std::move(ring));
        }
    }
    for (auto& hole : holes) {
        const auto group =
            groups.size() == 1
                ? groups.begin()
                : std::find_if(groups.begin(), groups.end(), [&](const std::vector<Path>& each) {
                      return is_around(each.front(), hole.front());
                  });
        if (group != groups.end()) {
            group->push_back(std::move(hole));
        }
    }
    std::vector<Path> ordered;
    for (auto& group : groups) {
        std::move(group.begin(), group.end(), std::back_inserter(ordered));
    }
    return ordered;
}

std::vector<Path> paths_between(const std::vector<Path>& paths,
                                bool are_lines,
                                std::int32_t CellPoint::*axis,
                                std::int32_t low,
                                std::int32_t high) {
    if (are_lines) {
        return lines_between(paths, axis, low, high);
    }
    return rings_within(rings_within(paths, axis, low, true), axis, high, false);
}

} // namespace macadam
