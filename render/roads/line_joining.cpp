#include "render/roads/line_joining.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace macadam {
namespace {

constexpr double min_cosine = 0.342; // of the turn between two lines: 70 degrees
constexpr std::size_t max_arms = 64; // a position with more line ends is not a junction

/// Rounds a position to 1e-7 degrees, a centimetre; equal keys are the same position.
std::uint64_t place_key(const GeoPoint& point) {
    const auto lat = std::uint32_t(std::llround(point.lat_deg * 1e7));
    const auto lon = std::uint32_t(std::llround(point.lon_deg * 1e7));
    return std::uint64_t(lat) << 32 | lon;
}

const GeoPoint& first_place(const MapLine& line, bool reversed) {
    return reversed ? line.line.back() : line.line.front();
}

bool has_direction(const MapLine& line) {
    return std::ranges::any_of(line.line, [&](const GeoPoint& point) {
        return place_key(point) != place_key(line.line.front());
    });
}

/// Returns true if all positions are valid. Longitudes of a map over the antimeridian may exceed
/// 180 degrees by one turn.
bool on_the_globe(const MapLine& line) {
    constexpr double farthest_deg = 540;
    return std::ranges::all_of(line.line, [](const GeoPoint& point) {
        return std::abs(point.lat_deg) <= 90 && std::abs(point.lon_deg) <= farthest_deg;
    });
}

PointEn unit_step(const GeoPoint& a, const GeoPoint& b) {
    const double shrink = std::cos(a.lat_deg * rad_per_deg);
    const PointEn step{(b.lon_deg - a.lon_deg) * shrink, b.lat_deg - a.lat_deg};
    const double length = std::hypot(step.east_m, step.north_m);
    return {step.east_m / length, step.north_m / length};
}

/// Returns the direction in which a line leaves its first position, or its last if it is reversed.
PointEn departure(const MapLine& line, bool reversed) {
    const auto& from = first_place(line, reversed);
    const auto differs = [&](const GeoPoint& point) { return place_key(point) != place_key(from); };
    if (reversed) {
        const auto next = std::ranges::find_if(line.line.rbegin(), line.line.rend(), differs);
        return unit_step(from, *next);
    }
    return unit_step(from, *std::ranges::find_if(line.line, differs));
}

using Kind = std::tuple<int, bool, bool>;

Kind kind_of(const MapLine& line) {
    return {line.rank, line.both_ways, line.iri_class < 0};
}

/// Returns the priority of a direction where only one can be shown: a class before the grey of few
/// passes, and that before no measurement; among classes, the worse.
int weight_of(const MapLine& line) {
    return line.iri_class < 0 ? 0 : line.few_passes ? 1 : 2 + line.iri_class;
}

struct Arm {
    std::uint64_t place;
    std::size_t use;
    bool leaves;
    PointEn onward; ///< driving direction at the position
};

std::vector<Arm> arms_of(std::span<const MapLine> lines, const std::vector<LineUse>& uses) {
    std::vector<Arm> arms;
    arms.reserve(uses.size() * 2);
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const auto& line = lines[uses[i].line];
        const bool reversed = uses[i].reversed;
        const auto back = departure(line, !reversed);
        arms.push_back(
            {place_key(first_place(line, reversed)), i, true, departure(line, reversed)});
        arms.push_back(
            {place_key(first_place(line, !reversed)), i, false, {-back.east_m, -back.north_m}});
    }
    std::ranges::stable_sort(arms, {}, &Arm::place);
    return arms;
}

struct Pair {
    double cosine;
    std::size_t from, to;
};

/// Returns the pairs, the straightest first.
std::vector<Pair> pairs_at(std::span<const Arm> arms,
                           std::span<const MapLine> lines,
                           const std::vector<LineUse>& uses) {
    std::vector<Pair> pairs;
    for (const auto& in : arms) {
        for (const auto& out : arms) {
            if (in.leaves || !out.leaves || in.use == out.use ||
                kind_of(lines[uses[in.use].line]) != kind_of(lines[uses[out.use].line])) {
                continue;
            }
            const double cosine =
                in.onward.east_m * out.onward.east_m + in.onward.north_m * out.onward.north_m;
            if (cosine >= min_cosine) {
                pairs.push_back({cosine, in.use, out.use});
            }
        }
    }
    std::ranges::stable_sort(pairs, std::ranges::greater{}, &Pair::cosine);
    return pairs;
}

} // namespace

std::vector<LineUse> all_lines(std::span<const MapLine> lines) {
    std::vector<LineUse> uses;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].line.size() >= 2 && on_the_globe(lines[i]) && has_direction(lines[i])) {
            uses.push_back({i});
        }
    }
    return uses;
}

std::vector<LineUse> worse_of_both_ways(std::span<const MapLine> lines) {
    using Track = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::size_t>;
    std::map<Track, std::size_t> known;
    std::vector<LineUse> uses;
    for (const auto& [index, unused] : all_lines(lines)) {
        const auto& line = lines[index];
        const bool reversed = line.both_ways && !line.forward;
        // Ends, number of points and second point distinguish intervals with the same ends.
        const auto second = reversed ? line.line[line.line.size() - 2] : line.line[1];
        const Track track{place_key(first_place(line, reversed)),
                          place_key(first_place(line, !reversed)),
                          place_key(second),
                          line.line.size()};
        const auto [twin, is_new] =
            line.both_ways ? known.try_emplace(track, uses.size()) : std::pair{known.end(), true};
        if (is_new) {
            uses.push_back({index, reversed});
        } else if (weight_of(lines[uses[twin->second].line]) < weight_of(line)) {
            uses[twin->second] = {index, reversed};
        }
    }
    return uses;
}

Neighbours neighbours_of(std::span<const MapLine> lines, const std::vector<LineUse>& uses) {
    Neighbours found{std::vector(uses.size(), no_neighbour),
                     std::vector(uses.size(), no_neighbour)};
    const auto arms = arms_of(lines, uses);
    for (auto first = arms.begin(); first != arms.end();) {
        const auto last = std::find_if(
            first, arms.end(), [&](const Arm& arm) { return arm.place != first->place; });
        if (std::size_t(last - first) <= max_arms) {
            for (const auto& pair : pairs_at({first, last}, lines, uses)) {
                if (found.next[pair.from] == no_neighbour &&
                    found.previous[pair.to] == no_neighbour) {
                    found.next[pair.from] = pair.to;
                    found.previous[pair.to] = pair.from;
                }
            }
        }
        first = last;
    }
    return found;
}

std::vector<std::vector<LineUse>> joined(std::span<const MapLine> lines,
                                         const std::vector<LineUse>& uses) {
    const auto [next, previous] = neighbours_of(lines, uses);
    std::vector<std::vector<LineUse>> chains;
    std::vector<bool> taken(uses.size(), false);
    const auto follow = [&](std::size_t start) {
        std::vector<LineUse> chain;
        for (auto at = start; at != no_neighbour && !taken[at]; at = next[at]) {
            taken[at] = true;
            chain.push_back(uses[at]);
        }
        if (!chain.empty()) {
            chains.push_back(std::move(chain));
        }
    };
    for (std::size_t i = 0; i < uses.size(); ++i) {
        if (previous[i] == no_neighbour) {
            follow(i);
        }
    }
    for (std::size_t i = 0; i < uses.size(); ++i) {
        follow(i); // rings have no start
    }
    return chains;
}

} // namespace macadam
