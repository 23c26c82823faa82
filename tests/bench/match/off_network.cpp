#include "off_network.hpp"
#include "mapping/matching/arcs.hpp"
#include "mapping/network/build_network.hpp"

#include "estimator/simulation/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace macadam::bench {
namespace {

constexpr double step_m = 1;
constexpr double parallel_deg = 30;
constexpr std::int64_t part_ids = std::int64_t{1} << 40; // beyond the ids of ways

/// A piece of a way between two points, in either direction: way, lower node, higher node.
using WayPiece = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

WayPiece piece_of(std::int64_t way, std::int64_t a, std::int64_t b) {
    return {way, std::min(a, b), std::max(a, b)};
}

void add_pieces(std::set<WayPiece>& pieces, const RoadNetwork& roads, EdgeId edge) {
    MatchedInterval whole{};
    whole.kind = IntervalKind::road;
    whole.edge = edge;
    whole.to_travel_m = length_m(roads, edge);
    whole.to_offset_m = length_m(roads, edge);
    for (const auto& arc : arcs_of({whole}, roads)) {
        pieces.insert(piece_of(arc.way_id, arc.from_node, arc.to_node));
    }
}

/// Ways without some pieces; what is left of a way between them has an id of its own.
std::vector<Way> without(const std::vector<Way>& ways, const std::set<WayPiece>& pieces) {
    std::vector<Way> left;
    for (const auto& way : ways) {
        Way part = way;
        std::int64_t parts = 0;
        const auto keep = [&] {
            if (part.line.size() >= 2) {
                part.id = way.id + part_ids * parts++;
                left.push_back(part);
            }
            part.node_ids.clear();
            part.line.clear();
        };
        part.node_ids.clear();
        part.line.clear();
        for (std::size_t i = 0; i < way.line.size(); ++i) {
            part.node_ids.push_back(way.node_ids[i]);
            part.line.push_back(way.line[i]);
            if (i + 1 < way.line.size() &&
                pieces.contains(piece_of(way.id, way.node_ids[i], way.node_ids[i + 1]))) {
                keep();
            }
        }
        keep();
    }
    return left;
}

/// Links of the route, drawn until they make `share` of it.
std::set<LinkId> drawn_links(const Drive& drive, double share, std::uint64_t seed) {
    Random random{seed};
    std::set<LinkId> drawn;
    double left_m = share * drive.start_m.back();
    while (left_m > 0) {
        const auto link = link_of(drive.route[random.below(drive.route.size())]);
        if (!drawn.insert(link).second) {
            continue;
        }
        for (std::size_t i = 0; i < drive.route.size(); ++i) {
            left_m -= link_of(drive.route[i]) == link ? drive.start_m[i + 1] - drive.start_m[i] : 0;
        }
    }
    return drawn;
}

/// Which metres of the route the map lacks.
std::vector<bool> lacking(const Drive& drive, const std::set<LinkId>& drawn) {
    std::vector<bool> lacks;
    std::size_t edge = 0;
    for (double route_m = step_m / 2; route_m < drive.start_m.back(); route_m += step_m) {
        while (drive.start_m[edge + 1] < route_m) {
            ++edge;
        }
        lacks.push_back(drawn.contains(link_of(drive.route[edge])));
    }
    return lacks;
}

bool near_border(const std::vector<bool>& lacks, std::size_t metre) {
    const auto reach = static_cast<std::size_t>(OffNetworkScore::border_m / step_m);
    const auto first = metre < reach ? 0 : metre - reach;
    const auto last = std::min(metre + reach, lacks.size() - 1);
    return lacks[first] != lacks[metre] || lacks[last] != lacks[metre];
}

/// Does a road of the map run abreast of the place, in either direction?
bool has_neighbour(const RoadNetwork& roads, const GeoPoint& at, double course) {
    GeoBox box;
    const auto around = grown(including(box, at), OffNetworkScore::neighbour_m);
    const ExactPlane plane{at};
    for (const auto link : links_near(roads, around)) {
        const auto line = line_of(roads, edge_of(link, true));
        for (std::size_t i = 1; i < line.size(); ++i) {
            const auto a = plane.to_plane(line[i - 1]);
            const auto b = plane.to_plane(line[i]);
            const double east_m = b.east_m - a.east_m;
            const double north_m = b.north_m - a.north_m;
            const double square = east_m * east_m + north_m * north_m;
            const double share =
                square > 0 ? -(a.east_m * east_m + a.north_m * north_m) / square : -1;
            if (share < 0 || share > 1) { // before or behind, as where the same road goes on
                continue;
            }
            const double away_m =
                std::hypot(a.east_m + share * east_m, a.north_m + share * north_m);
            const double turn_deg =
                std::abs(std::remainder(course_deg(line[i - 1], line[i]) - course, 180));
            if (away_m <= OffNetworkScore::neighbour_m && turn_deg <= parallel_deg) {
                return true;
            }
        }
    }
    return false;
}

/// The kind of piece at each travel, asked in rising order.
class Kinds {
public:
    explicit Kinds(const MatchedTrace& trace) : trace_{trace} {}

    IntervalKind at(double travel_m) {
        while (last_ + 1 < trace_.size() && trace_[last_].to_travel_m < travel_m) {
            ++last_;
        }
        return last_ < trace_.size() ? trace_[last_].kind : IntervalKind::gap;
    }

private:
    const MatchedTrace& trace_;
    std::size_t last_ = 0;
};

OffNetworkScore score_of_drive(const DrivenNetwork& network,
                               std::size_t number,
                               const Scenario& scenario,
                               double share,
                               std::uint64_t seed) {
    const auto& drive = network.drives[number];
    const auto drawn = drawn_links(drive, share, seed_of({seed, number}));
    std::set<WayPiece> pieces;
    for (const auto link : drawn) {
        add_pieces(pieces, network.roads, edge_of(link, true));
    }
    const auto roads = build_network(without(network.ways, pieces));
    const auto recording = recorded(network, number, scenario);
    const auto found = matched(recording.trip, roads);
    const auto lacks = lacking(drive, drawn);
    const double from_s = recording.trip.fixes.front().t_s - recording.latency_s;
    const double to_s = recording.trip.fixes.back().t_s - recording.latency_s;

    OffNetworkScore score;
    Kinds kinds{found.trace};
    for (std::size_t i = 0; i < lacks.size(); ++i) {
        const double t_s = t_s_at(drive, step_m * (static_cast<double>(i) + 0.5));
        if (t_s < from_s || t_s > to_s || near_border(lacks, i)) {
            continue;
        }
        const auto kind = kinds.at(found.odometer.travel_m(t_s));
        const bool off = kind == IntervalKind::off_network;
        score.length_m += step_m;
        score.told_m += off ? step_m : 0;
        if (!lacks[i]) {
            continue;
        }
        score.deleted_m += step_m;
        score.noticed_m += off ? step_m : 0;
        const auto place = drive.path.plane.to_geo(place_at_time(drive, t_s).at);
        const auto ahead = drive.path.plane.to_geo(place_at_time(drive, t_s + 1).at);
        const bool beside = has_neighbour(roads, place, course_deg(place, ahead));
        score.beside_m += beside ? step_m : 0;
        if (kind == IntervalKind::road) {
            score.false_road_m += step_m;
            score.beside_false_m += beside ? step_m : 0;
        }
    }
    return score;
}

OffNetworkScore together(OffNetworkScore sum, const OffNetworkScore& one) {
    for (double OffNetworkScore::*const part : {&OffNetworkScore::length_m,
                                                &OffNetworkScore::deleted_m,
                                                &OffNetworkScore::noticed_m,
                                                &OffNetworkScore::told_m,
                                                &OffNetworkScore::false_road_m,
                                                &OffNetworkScore::beside_m,
                                                &OffNetworkScore::beside_false_m}) {
        sum.*part += one.*part;
    }
    return sum;
}

} // namespace

OffNetworkScore off_network_score(std::span<const DrivenNetwork> world,
                                  const Scenario& scenario,
                                  double share,
                                  std::uint64_t seed) {
    OffNetworkScore sum;
    for (const auto& network : world) {
        for (std::size_t i = 0; i < network.drives.size(); ++i) {
            sum = together(sum, score_of_drive(network, i, scenario, share, seed));
        }
    }
    return sum;
}

} // namespace macadam::bench
