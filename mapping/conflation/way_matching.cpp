#include "mapping/conflation/way_matching.hpp"

#include "mapping/conflation/viterbi_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double sample_step_m = 10;
constexpr std::size_t samples_at_once = 32; // per search in the index

// Costs are negative log-likelihoods per ten metres of road.
constexpr double sd_across_m = 3; // displacement of an unchanged road by remapping
constexpr double other_name_cost = 1.5;
constexpr double other_class_cost = 0.7;
constexpr double other_id_cost = 0.3;
constexpr double no_junction_cost = 1.0;
constexpr double other_junction_cost = 0.4;
constexpr double junction_reach_m = 12;

std::vector<std::uint32_t> links_met(const RoadNetwork& roads) {
    std::vector<std::uint32_t> met(node_count(roads), 0);
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        ++met[roads.links[i].from];
        ++met[roads.links[i].to];
    }
    return met;
}

/// Returns the sampling offsets along a link, including its end.
std::vector<double> even_offsets_m(double length_m) {
    const double steps = std::max(1.0, std::ceil(length_m / sample_step_m));
    std::vector<double> offsets_m;
    for (double i = 1; i <= steps; ++i) {
        offsets_m.push_back(length_m * i / steps);
    }
    return offsets_m;
}

double cost_of_words(const WayView& before, const WayView& after) {
    const bool other_name =
        before.name != after.name && !before.name.empty() && !after.name.empty();
    return (other_name ? other_name_cost : 0) +
           (before.highway != after.highway ? other_class_cost : 0) +
           (before.id != after.id ? other_id_cost : 0);
}

/// Builds the state of a sample at a junction or end: it is moved to a nearby node where equally
/// many roads meet. At a junction, a different kind of junction, or none, adds a cost.
ViterbiState at_node(const RoadNetwork& after,
                     const std::vector<std::uint32_t>& met,
                     const EdgeCandidate& place,
                     std::uint32_t roads_met) {
    constexpr std::uint32_t least_of_junction = 3;
    const bool is_junction = roads_met >= least_of_junction;
    ViterbiState state{place.edge, place.offset_m, is_junction ? no_junction_cost : 0};
    double nearest_m = junction_reach_m;
    const auto look_at = [&](NodeId node, double at_m) {
        const auto there = met[static_cast<std::uint32_t>(node)];
        const double off_m = std::hypot(at_m - place.offset_m, place.across_m);
        if (off_m <= nearest_m && there == roads_met) {
            nearest_m = off_m;
            state = {place.edge, at_m, 0, true};
        } else if (off_m <= junction_reach_m && there >= least_of_junction && is_junction) {
            state.cost = std::min(state.cost, other_junction_cost);
        }
    };
    look_at(from_node(after, place.edge), 0);
    look_at(to_node(after, place.edge), length_m(after, place.edge));
    return state;
}

/// Returns true for a point within a way, or where one way merely continues as the next.
bool is_between(std::uint32_t roads_met) {
    return roads_met == 0 || roads_met == 2;
}

/// Returns the length of way that each sample represents, in tens of metres.
std::vector<double> weights_of(const std::vector<RoadSample>& samples) {
    std::vector<double> weights;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double from_m = samples[i == 0 ? i : i - 1].offset_m;
        const double to_m = samples[i + 1 == samples.size() ? i : i + 1].offset_m;
        weights.push_back((to_m - from_m) / 2 / sample_step_m);
    }
    return weights;
}

} // namespace

WayMatcher::WayMatcher(const RoadNetwork& before,
                       const RoadNetwork& after,
                       const std::vector<bool>& left_out,
                       const ChangeConfig& config)
    : before_{&before}, after_{&after}, near_{after, left_out, config}, config_{config},
      met_before_{links_met(before)}, met_after_{links_met(after)} {}

std::vector<RoadSample> WayMatcher::samples_of(const WayView& way, bool forward) const {
    const double whole_m = way.along_m.back();
    const double sign = forward ? 1 : -1;
    std::vector<RoadSample> samples;
    const auto add = [&](double along_m, std::uint32_t roads_met) {
        samples.push_back({.offset_m = forward ? along_m : whole_m - along_m,
                           .behind = place_along(way, along_m - sign * half_chord_m),
                           .at = place_along(way, along_m),
                           .ahead = place_along(way, along_m + sign * half_chord_m),
                           .roads_met = roads_met});
    };
    const auto met = [&](NodeId node) { return met_before_[static_cast<std::uint32_t>(node)]; };
    add(0, met(link_at(*before_, LinkId{way.first_link}).from));
    for (auto i = way.first_link; i < way.past_link; ++i) {
        const auto link = link_at(*before_, LinkId{i});
        for (const double offset_m : even_offsets_m(link.to_m - link.from_m)) {
            const bool is_end = link.from_m + offset_m >= link.to_m;
            add(std::min(link.to_m, link.from_m + offset_m), is_end ? met(link.to) : 0);
        }
    }
    if (!forward) {
        std::ranges::reverse(samples);
    }
    return samples;
}

WayMatching
WayMatcher::match(std::uint32_t number, bool forward, const std::set<EdgeId>& barred) const {
    const auto way = way_at(*before_, number);
    const auto samples = samples_of(way, forward);
    const auto weights = weights_of(samples);
    WayLattice lattice{*after_};
    for (std::size_t first = 0; first < samples.size(); first += samples_at_once) {
        const auto count = std::min(samples_at_once, samples.size() - first);
        const auto around = near_.around(std::span{samples}.subspan(first, count));
        for (std::size_t i = 0; i < count; ++i) {
            const auto& sample = samples[first + i];
            std::vector<ViterbiState> states;
            for (const auto& place : around[i]) {
                if (!barred.contains(place.edge)) {
                    const double off = place.across_m / sd_across_m;
                    const double cost =
                        off * off / 2 + cost_of_words(way, way_of(*after_, place.edge));
                    auto state = is_between(sample.roads_met)
                                     ? ViterbiState{place.edge, place.offset_m, 0}
                                     : at_node(*after_, met_after_, place, sample.roads_met);
                    state.cost += weights[first + i] * cost;
                    states.push_back(state);
                }
            }
            lattice.add(sample.offset_m, weights[first + i], std::move(states));
        }
    }
    return lattice.likeliest();
}

} // namespace macadam
