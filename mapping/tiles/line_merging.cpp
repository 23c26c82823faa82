#include "mapping/tiles/line_merging.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr double min_cosine = 0.5; // a turn of 60 degrees
constexpr auto none = std::numeric_limits<std::size_t>::max();

/// An end of a part: 2 * part is the start of its line, 2 * part + 1 its end.
using End = std::size_t;

struct Meeting {
    double cosine; ///< 1: straight on
    End a, b;
};

WorldPoint place_of(const std::vector<RoadPart>& parts, End end) {
    const auto& line = parts[end / 2].line;
    return end % 2 == 0 ? line.front() : line.back();
}

/// Returns the unit vector out of the part at that end; 0 if its line has no direction.
std::pair<double, double> way_out(const std::vector<RoadPart>& parts, End end) {
    const auto& line = parts[end / 2].line;
    const auto at = place_of(parts, end);
    const auto step = [&](std::size_t i) {
        return end % 2 == 0 ? line[i] : line[line.size() - 1 - i];
    };
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (const auto from = step(i); from != at) {
            const double x = double(at.x) - from.x, y = double(at.y) - from.y;
            const double length = std::sqrt(x * x + y * y);
            return {x / length, y / length};
        }
    }
    return {0, 0};
}

bool is_same_road(const RoadPart& a, const RoadPart& b) {
    return a.is_directed == b.is_directed && a.name == b.name &&
           (a.name != 0 || a.highway == b.highway);
}

bool may_meet(const std::vector<RoadPart>& parts, End a, End b) {
    const auto &of_a = parts[a / 2], &of_b = parts[b / 2];
    return a / 2 != b / 2 && is_same_road(of_a, of_b) && (!of_a.is_directed || a % 2 != b % 2);
}

/// Adds all pairs of ends that coincide.
void add_meetings(const std::vector<RoadPart>& parts,
                  std::span<const End> ends,
                  std::vector<Meeting>& meetings) {
    for (std::size_t i = 0; i < ends.size(); ++i) {
        for (std::size_t j = i + 1; j < ends.size(); ++j) {
            if (!may_meet(parts, ends[i], ends[j])) {
                continue;
            }
            const auto [ax, ay] = way_out(parts, ends[i]);
            const auto [bx, by] = way_out(parts, ends[j]);
            if (const double cosine = -(ax * bx + ay * by); cosine >= min_cosine) {
                meetings.push_back({cosine, ends[i], ends[j]});
            }
        }
    }
}

/// Returns the end that each end continues with, or none.
std::vector<End> partners_of(const std::vector<RoadPart>& parts) {
    std::vector<End> ends(2 * parts.size());
    for (End end = 0; end < ends.size(); ++end) {
        ends[end] = end;
    }
    std::ranges::sort(ends, {}, [&](End end) { return std::pair{place_of(parts, end), end}; });
    std::vector<Meeting> meetings;
    for (std::size_t first = 0, past = 0; first < ends.size(); first = past) {
        while (past < ends.size() && place_of(parts, ends[past]) == place_of(parts, ends[first])) {
            ++past;
        }
        add_meetings(parts, std::span{ends}.subspan(first, past - first), meetings);
    }
    std::ranges::sort(meetings, {}, [](const Meeting& meeting) {
        return std::tuple{-meeting.cosine, meeting.a, meeting.b};
    });
    std::vector<End> partners(ends.size(), none);
    for (const auto& [cosine, a, b] : meetings) {
        if (partners[a] == none && partners[b] == none) {
            partners[a] = b;
            partners[b] = a;
        }
    }
    return partners;
}

} // namespace

std::vector<std::vector<PartUse>> part_chains(const std::vector<RoadPart>& parts) {
    const auto partners = partners_of(parts);
    std::vector<bool> done(parts.size(), false);
    std::vector<std::vector<PartUse>> chains;
    const auto follow = [&](End begin) {
        auto& chain = chains.emplace_back();
        for (auto end = begin; end != none && !done[end / 2];) {
            done[end / 2] = true;
            chain.push_back({end / 2, end % 2 == 1});
            end = partners[end ^ 1U];
        }
    };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!done[i] && partners[2 * i] == none) {
            follow(2 * i);
        } else if (!done[i] && partners[2 * i + 1] == none && !parts[i].is_directed) {
            follow(2 * i + 1);
        }
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!done[i]) {
            follow(2 * i);
        }
    }
    return chains;
}

} // namespace macadam
