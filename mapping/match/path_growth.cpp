#include "mapping/match/path_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr double fit_sds = 3; // off its lane: a car on the road is seldom farther
constexpr double farthest_m = 20;
constexpr double fit_course_rad = 30 * std::numbers::pi / 180;
constexpr double corner_m = 15;   // within, a car's course is not yet, or no longer, the edge's
constexpr double end_m = 0.5;     // this near to an edge's end it is passed
constexpr double most_sure = 0.9; // no sample of the lattice stands behind it
constexpr int edges_at_once = 4;  // so that forks do not multiply
constexpr double longest_blind_m = 30; // of edges that no position touched

/// A position on an edge.
struct Touch {
    std::size_t position;
    double offset_m; ///< in the edge's direction of travel
};

/// Edges one after the other, away from the path, with the positions on each.
struct Growth {
    struct Part {
        EdgeId edge;
        std::vector<Touch> touches;
    };
    std::vector<Part> parts;
    std::size_t touches = 0;
};

/// Which way a path grows: with time at its end, against it at its beginning.
enum class Grows : std::int8_t { forward = 1, backward = -1 };

class Grower {
public:
    Grower(const RoadNetwork& roads,
           RoadPlane& plane,
           const Positions& positions,
           const RoadSpread& spread,
           Grows way,
           std::ptrdiff_t limit)
        : roads_{roads}, plane_{plane},
          positions_{positions}, spread_{spread}, way_{way}, limit_{limit} {}

    /// On `edge`, from a position on, and over those that follow it.
    Growth on(EdgeId edge,
              std::ptrdiff_t from,
              int ahead = edges_at_once,
              double blind_m = longest_blind_m) {
        Growth growth{{{edge, {}}}, 0};
        auto& touches = growth.parts.front().touches;
        const double edge_m = length_m(roads_, edge);
        for (; from != limit_; from += static_cast<int>(way_)) {
            const auto touched = at(edge, edge_m, static_cast<std::size_t>(from));
            if (touched.passed) {
                const double left_m = touches.empty() ? blind_m - edge_m : longest_blind_m;
                return joined(std::move(growth), best_beyond(edge, from, ahead - 1, left_m));
            }
            if (touched.fits) {
                touches.push_back({static_cast<std::size_t>(from), touched.offset_m});
                ++growth.touches;
            } else if (!touched.near_joint) {
                break;
            }
        }
        return growth;
    }

private:
    /// The growth over an edge beyond the end of `edge` that the most positions lie on.
    Growth best_beyond(EdgeId edge, std::ptrdiff_t from, int ahead, double blind_m) {
        Growth best;
        if (ahead == 0 || blind_m <= 0) {
            return best;
        }
        for (const auto next : beyond(edge)) {
            auto growth = on(next, from, ahead, blind_m);
            if (growth.touches > best.touches) {
                best = std::move(growth);
            }
        }
        return best;
    }

    struct Place {
        double offset_m;
        bool passed;
        bool near_joint; ///< to where the growth came from
        bool fits;
    };

    Place at(EdgeId edge, double edge_m, std::size_t position) {
        const auto place = plane_.nearest(link_of(edge), positions_.all[position].at);
        const bool forward = is_forward(edge);
        const double offset_m = forward ? place.along_m : edge_m - place.along_m;
        const double gone_m = way_ == Grows::forward ? offset_m : edge_m - offset_m;
        const double lane_m =
            is_drivable(roads_, reversed(edge)) ? spread_.two_way_lane_m : spread_.oneway_lane_m;
        const double off_lane_m = (forward ? place.right_m : -place.right_m) - lane_m;
        const bool near =
            std::abs(off_lane_m) <= fit_sds * spread_.close_sd_m && place.distance_m <= farthest_m;
        const double course_rad = place.course_rad + (forward ? 0.0 : std::numbers::pi);
        const double apart_rad = std::abs(
            std::remainder(course_rad_at(positions_, position) - course_rad, 2 * std::numbers::pi));
        const bool along = !(apart_rad > fit_course_rad); // where unknown, it does not disagree
        return {offset_m,
                gone_m >= edge_m - end_m,
                near && gone_m < corner_m,
                near && gone_m > end_m && (along || edge_m - gone_m < corner_m)};
    }

    std::vector<EdgeId> beyond(EdgeId edge) const {
        std::vector<EdgeId> edges;
        if (way_ == Grows::forward) {
            for (const auto next : out_edges(roads_, to_node(roads_, edge))) {
                if (next != reversed(edge) && may_turn(roads_, edge, next)) {
                    edges.push_back(next);
                }
            }
            return edges;
        }
        const auto node = from_node(roads_, edge);
        const auto around = grown(including({}, place_of(roads_, node)), 1);
        for (const auto link : links_near(roads_, around)) {
            for (const auto before : {edge_of(link, true), edge_of(link, false)}) {
                if (is_drivable(roads_, before) && to_node(roads_, before) == node &&
                    before != reversed(edge) && may_turn(roads_, before, edge)) {
                    edges.push_back(before);
                }
            }
        }
        return edges;
    }

    static Growth joined(Growth growth, Growth rest) {
        if (rest.touches > 0) {
            growth.touches += rest.touches;
            std::ranges::move(rest.parts, std::back_inserter(growth.parts));
        }
        return growth;
    }

    const RoadNetwork& roads_;
    RoadPlane& plane_;
    const Positions& positions_;
    const RoadSpread& spread_;
    Grows way_;
    std::ptrdiff_t limit_;
};

double grown_confidence(const Leg& neighbour) {
    return std::min(neighbour.confidence, most_sure);
}

void append(RoadPath& path, const std::vector<Touch>& touches) {
    const auto& leg = path.legs.back();
    for (const auto& [position, offset_m] : touches) {
        path.positions.push_back(position);
        path.sample_m.push_back(
            std::max(path.sample_m.back(), leg.start_m + offset_m - leg.from_m));
    }
}

/// \param touches  the last one first.
void prepend(RoadPath& path, const std::vector<Touch>& touches) {
    const double from_m = path.legs.front().from_m;
    std::vector<std::size_t> positions;
    std::vector<double> sample_m;
    double next_m = path.sample_m.front();
    for (const auto& [position, offset_m] : touches) {
        next_m = std::min(next_m, offset_m - from_m);
        positions.push_back(position);
        sample_m.push_back(next_m);
    }
    path.positions.insert(path.positions.begin(), positions.rbegin(), positions.rend());
    path.sample_m.insert(path.sample_m.begin(), sample_m.rbegin(), sample_m.rend());
}

void append_leg(RoadPath& path, const RoadNetwork& roads, EdgeId edge) {
    path.legs.push_back(
        {edge, 0, length_m(roads, edge), length_m(path), grown_confidence(path.legs.back())});
}

void prepend_leg(RoadPath& path, const RoadNetwork& roads, EdgeId edge) {
    const double edge_m = length_m(roads, edge);
    for (auto& leg : path.legs) {
        leg.start_m += edge_m;
    }
    for (auto& at_m : path.sample_m) {
        at_m += edge_m;
    }
    path.legs.insert(path.legs.begin(), {edge, 0, edge_m, 0, grown_confidence(path.legs.front())});
}

} // namespace

void grow_end(RoadPath& path,
              const RoadNetwork& roads,
              RoadPlane& plane,
              const Positions& positions,
              const RoadSpread& spread,
              std::size_t limit) {
    const auto end = static_cast<std::ptrdiff_t>(limit);
    Grower grower{roads, plane, positions, spread, Grows::forward, end};
    for (bool more = true; more;) {
        const auto from = static_cast<std::ptrdiff_t>(path.positions.back()) + 1;
        const auto growth = grower.on(path.legs.back().edge, std::min(from, end));
        append(path, growth.parts.front().touches);
        for (std::size_t i = 1; i < growth.parts.size(); ++i) {
            append_leg(path, roads, growth.parts[i].edge);
            append(path, growth.parts[i].touches);
        }
        more = growth.parts.size() == edges_at_once;
    }
}

void grow_begin(RoadPath& path,
                const RoadNetwork& roads,
                RoadPlane& plane,
                const Positions& positions,
                const RoadSpread& spread,
                std::size_t first) {
    const auto end = static_cast<std::ptrdiff_t>(first) - 1;
    Grower grower{roads, plane, positions, spread, Grows::backward, end};
    for (bool more = true; more;) {
        const auto from = static_cast<std::ptrdiff_t>(path.positions.front()) - 1;
        const auto growth = grower.on(path.legs.front().edge, std::max(from, end));
        prepend(path, growth.parts.front().touches);
        for (std::size_t i = 1; i < growth.parts.size(); ++i) {
            prepend_leg(path, roads, growth.parts[i].edge);
            prepend(path, growth.parts[i].touches);
        }
        more = growth.parts.size() == edges_at_once;
    }
}

} // namespace macadam
