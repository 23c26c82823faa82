#include "mapping/matching/lattice/lattice.hpp"

#include "estimator/common/angle.hpp"
#include "mapping/matching/lattice/off_network.hpp"
#include "mapping/matching/lattice/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace macadam {
namespace {

constexpr double off_nats = 2;     // per sampling distance off the network: like a road 2 sd away
constexpr double off_fit_nats = 1; // additional cost if some road fits
constexpr double off_switch_nats = 6; // for leaving the network and for returning
constexpr double well_back_nats = 8;  // discount for returning to a road that fits
constexpr double hopeless_nats = 5;   // worse than another path by more: not examined further
constexpr double sideways_nats = 12;  // additional cost of moving over to a parallel road
constexpr float off_end_nats = 3;     // for beginning or ending off the network
constexpr double hop_nats = 16;       // for leaving and returning between two samples
constexpr double gap_nats = 25;       // for a discontinuity: more than any credible detour
constexpr double beam_nats = 15;      // worse than the best by more: pruned ...
constexpr double off_beam_nats = beam_nats + off_switch_nats + sideways_nats; // ... and if the best
                                                                              // has to return
constexpr std::size_t widest_beam = 12;
constexpr std::size_t widest_far_beam = 5; // if each state needs a long search
constexpr double far_m = 1000;

constexpr double fit_sds = 2; // lateral tolerance of a road that fits
constexpr double fit_course_sd_rad = 15 * rad_per_deg;
constexpr double farthest_fit_m = 20;
constexpr double fit_without_course_nats = 1.2; // a near road may lead another way

constexpr std::size_t max_samples = 8192;      // held in memory at once: 250 km
constexpr std::size_t settling_samples = 1024; // samples that later positions may still change

constexpr double never = std::numeric_limits<double>::infinity();

double distance_nats(double distance_m, double sd_m) {
    const double sds = distance_m / sd_m;
    return sds * sds / 2;
}

/// Von Mises: quadratic like a normal distribution for small angles, bounded for large ones.
double course_nats(double angle_rad, double sd_rad) {
    return (1 - std::cos(angle_rad)) / (sd_rad * sd_rad);
}

double fit(const NearestPoint& place,
           double right_m,
           double course_rad,
           const ObservationModel& evidence,
           double close_sd_m) {
    if (place.distance_m > farthest_fit_m) {
        return 0;
    }
    const double nats = std::isnan(evidence.course_rad)
                            ? fit_without_course_nats
                            : course_nats(evidence.course_rad - course_rad, fit_course_sd_rad);
    return std::exp(-nats - distance_nats(right_m, fit_sds * close_sd_m));
}

void add_candidates(std::vector<State>& states,
                    const RoadNetwork& roads,
                    const std::vector<NearestPoint>& places,
                    const ObservationModel& evidence,
                    const RoadSpread& spread,
                    const MatchConfig& config) {
    const auto first = states.size();
    const auto full = [&] {
        return states.size() - first >= static_cast<std::size_t>(config.max_candidates);
    };
    double best_fit = 0;
    for (const auto& place : places) {
        const double distance = distance_nats(place.distance_m, evidence.sd_m);
        for (const bool forward : {true, false}) {
            const auto edge = edge_of(place.link, forward);
            if (full() || !is_drivable(roads, edge)) {
                continue;
            }
            const double course_rad = place.course_rad + (forward ? 0.0 : std::numbers::pi);
            const double course =
                std::isnan(evidence.course_rad)
                    ? 0
                    : course_nats(evidence.course_rad - course_rad, evidence.course_sd_rad);
            const double lane_m =
                is_drivable(roads, reversed(edge)) ? spread.two_way_lane_m : spread.oneway_lane_m;
            const double right_m = (forward ? place.right_m : -place.right_m) - lane_m;
            const double road_fit = fit(place, right_m, course_rad, evidence, spread.close_sd_m);
            best_fit = std::max(best_fit, road_fit);
            const double offset_m = forward ? place.along_m : length_m(roads, edge) - place.along_m;
            states.push_back({{false,
                               edge,
                               offset_m,
                               static_cast<float>(course_rad),
                               static_cast<float>(evidence.weight * (distance + course)),
                               static_cast<float>(right_m),
                               static_cast<float>(road_fit)},
                              never,
                              0});
        }
    }
    const double off = evidence.weight * off_nats + off_fit_nats * best_fit;
    states.push_back({{true, EdgeId{}, 0, 0, static_cast<float>(off), 0, 0}, never, 0});
}

/// Returns the states of a sample within the beam, best first.
std::vector<std::uint32_t>
survivors(const Lattice& lattice, std::size_t sample, std::size_t widest) {
    std::vector<std::uint32_t> order(lattice.first_state[sample + 1] - lattice.first_state[sample]);
    std::iota(order.begin(), order.end(), static_cast<std::uint32_t>(lattice.first_state[sample]));
    const auto cheaper = [&](std::uint32_t a, std::uint32_t b) {
        const auto& x = lattice.states[a];
        const auto& y = lattice.states[b];
        return x.cost < y.cost || (x.cost == y.cost && a < b);
    };
    const auto best = *std::min_element(order.begin(), order.end(), cheaper);
    const bool is_off = lattice.states[best].candidate.off_network;
    const double worst = lattice.states[best].cost + (is_off ? off_beam_nats : beam_nats);
    std::erase_if(order, [&](std::uint32_t state) { return lattice.states[state].cost > worst; });
    std::sort(order.begin(), order.end(), cheaper);
    order.resize(std::min(order.size(), widest));
    return order;
}

std::vector<EdgeId> edges_of(std::span<const State> states) {
    std::vector<EdgeId> edges;
    for (const auto& state : states) {
        if (!state.candidate.off_network) {
            edges.push_back(state.candidate.edge);
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

class Builder {
public:
    Builder(const RoadNetwork& roads,
            CandidateIndex& plane,
            EdgeRouter& routes,
            const MatchObservations& positions,
            const MatchConfig& config)
        : roads_{roads}, plane_{plane}, routes_{routes}, positions_{positions}, config_{config},
          spread_{road_spread(positions, roads, plane, config)} {}

    /// Adds a sample; call in order.
    void add(std::size_t sample) {
        add_states(sample);
        if (sample > 0) {
            add_transitions(sample);
        }
        lattice_.first_transition.push_back(lattice_.transitions.size());
    }

    const Lattice& lattice() const { return lattice_; }
    std::size_t first() const { return first_; } ///< first sample held
    std::size_t held() const { return lattice_.first_state.size() - 1; }

    /// Drops the first samples, and the transitions into the next one.
    void drop(std::size_t count) {
        const auto cut = [](auto& values, std::size_t until) {
            values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(until));
        };
        const auto states = lattice_.first_state[count];
        const auto transitions = lattice_.first_transition[count + 1];
        cut(lattice_.states, states);
        cut(lattice_.transitions, transitions);
        cut(lattice_.first_state, count);
        cut(lattice_.first_transition, count);
        lattice_.first_transition.front() = transitions;
        for (auto& state : lattice_.states) {
            state.arrival -= static_cast<std::uint32_t>(transitions);
        }
        for (auto& transition : lattice_.transitions) {
            transition.from -= static_cast<std::uint32_t>(states);
            transition.to -= static_cast<std::uint32_t>(states);
        }
        std::ranges::for_each(lattice_.first_state, [=](auto& first) { first -= states; });
        std::ranges::for_each(lattice_.first_transition,
                              [=](auto& first) { first -= transitions; });
        first_ += count;
    }

private:
    void add_states(std::size_t sample) {
        if (sample == 0) {
            lattice_.first_state.push_back(0);
            lattice_.first_transition.push_back(0);
        }
        const auto& position = positions_.all[positions_.samples[sample]];
        const auto first = lattice_.states.size();
        add_candidates(lattice_.states,
                       roads_,
                       plane_.near(position.at, position.place, config_.search_radius_m),
                       evidence_of(positions_, sample, spread_.sd_m, config_),
                       spread_,
                       config_);
        lattice_.first_state.push_back(lattice_.states.size());
        if (sample == 0 || sample + 1 == positions_.samples.size()) {
            lattice_.states.back().candidate.cost += off_end_nats;
        }
        if (sample == 0) {
            for (auto i = first; i < lattice_.states.size(); ++i) {
                lattice_.states[i].cost = lattice_.states[i].candidate.cost;
            }
        }
    }

    void add_transitions(std::size_t sample) {
        const auto between = between_samples(
            positions_, positions_.samples[sample - 1], positions_.samples[sample], config_);
        const bool far = between.travelled_m > far_m;
        const auto from =
            survivors(lattice_, sample - 1 - first_, far ? widest_far_beam : widest_beam);
        const auto targets = longest_way_m(between, config_) > EdgeRouter::kept_m
                                 ? edges_of(lattice_.states_of(sample - first_))
                                 : std::vector<EdgeId>{};
        for (const auto state : from) {
            leave(state, sample, targets, between, state == from.front());
        }
    }

    void leave(std::uint32_t from,
               std::size_t sample,
               const std::vector<EdgeId>& targets,
               const SamplePair& between,
               bool best) {
        const auto candidate = lattice_.states[from].candidate;
        const auto* reached =
            candidate.off_network
                ? nullptr
                : &reached_from(routes_, candidate.edge, targets, between, config_);
        const auto last = static_cast<std::uint32_t>(lattice_.states.size());
        for (auto to = static_cast<std::uint32_t>(lattice_.first_state[sample - first_]); to < last;
             ++to) {
            const auto& target = lattice_.states[to].candidate;
            if (candidate.off_network || target.off_network) {
                double cost = off_way_nats(between);
                if (!candidate.off_network) {
                    cost += off_switch_nats;
                } else if (!target.off_network) {
                    cost += return_nats(from, sample, to, between);
                }
                add({from, to, static_cast<float>(std::min(cost, gap_nats)), false});
                continue;
            }
            const auto move = move_of(roads_, *reached, candidate, target, between, config_);
            if (move) {
                double cost = cost_of(*move, between) + turn_cost(candidate, target, between);
                if (cost < gap_nats) {
                    cost += lateral_jump_cost(candidate, target, between, spread_.close_sd_m);
                    add({from, to, static_cast<float>(cost), true});
                }
            }
            if (best) {
                const double cost = between.dense ? hop_nats : gap_nats;
                add({from, to, static_cast<float>(cost), false});
            }
        }
    }

    /// Computes the cost of returning to the network at a state of `sample`.
    double return_nats(std::uint32_t from,
                       std::size_t sample,
                       std::uint32_t to_state,
                       const SamplePair& between) const {
        const auto& target = lattice_.states[to_state].candidate;
        const double well = off_switch_nats - static_cast<double>(target.fit) * well_back_nats;
        const bool hopeless = lattice_.states[from].cost + well + static_cast<double>(target.cost) >
                              lattice_.states[to_state].cost + hopeless_nats;
        const double share =
            hopeless ? 0
                     : off_network_probability(
                           lattice_, from, sample - 1, target, positions_, plane_, roads_);
        return std::lerp(off_switch_nats + sideways_nats, well, share) +
               lateral_jump_cost(
                   lattice_.states[from].candidate, target, between, spread_.close_sd_m);
    }

    /// A sample represents one sampling distance; travel off the network beyond it costs the same
    /// per metre.
    double off_way_nats(const SamplePair& between) const {
        const double beyond_m = std::max(0.0, between.travelled_m - 2 * config_.spacing_m);
        return between.usual_nats + off_nats * beyond_m / config_.spacing_m;
    }

    void add(const LatticeArc& transition) {
        auto& to = lattice_.states[transition.to];
        const double cost =
            lattice_.states[transition.from].cost + transition.cost + to.candidate.cost;
        if (cost < to.cost) {
            to.cost = cost;
            to.arrival = lattice_.transitions.size();
        }
        lattice_.transitions.push_back(transition);
    }

    const RoadNetwork& roads_;
    CandidateIndex& plane_;
    EdgeRouter& routes_;
    const MatchObservations& positions_;
    const MatchConfig& config_;
    RoadSpread spread_;
    Lattice lattice_;
    std::size_t first_ = 0; ///< first sample of the lattice
};

double confidence_of(const Lattice& lattice,
                     const std::vector<double>& posterior,
                     std::size_t sample,
                     const Candidate& chosen) {
    double sum = 0;
    for (auto i = lattice.first_state[sample]; i < lattice.first_state[sample + 1]; ++i) {
        const auto& candidate = lattice.states[i].candidate;
        if (candidate.off_network == chosen.off_network && candidate.edge == chosen.edge) {
            sum += posterior[i];
        }
    }
    return std::min(sum, 1.0);
}

/// Assigns states to the first `settled` + 1 samples of a lattice by backtracking the cheapest
/// path. An earlier choice for its first sample is kept, as it was based on the transitions into
/// it.
void choose(std::vector<BestState>& chain,
            const Lattice& lattice,
            const std::vector<double>& posterior,
            std::size_t first,
            std::size_t settled,
            const MatchObservations& positions) {
    const auto held = lattice.first_state.size() - 1;
    const auto last = lattice.states_of(held - 1);
    auto at = static_cast<std::size_t>(
        std::min_element(last.begin(),
                         last.end(),
                         [](const State& a, const State& b) { return a.cost < b.cost; }) -
        last.begin() + static_cast<std::ptrdiff_t>(lattice.first_state[held - 1]));
    for (auto sample = held; sample-- > (first > 0 ? 1U : 0U);) {
        const auto& state = lattice.states[at];
        if (sample <= settled) {
            chain[first + sample] = {positions.samples[first + sample],
                                     state.candidate,
                                     sample > 0 && lattice.transitions[state.arrival].joined,
                                     confidence_of(lattice, posterior, sample, state.candidate)};
        }
        at = sample > 0 ? lattice.transitions[state.arrival].from : 0;
    }
}

} // namespace

std::vector<BestState> viterbi_path(const RoadNetwork& roads,
                                    CandidateIndex& plane,
                                    EdgeRouter& routes,
                                    const MatchObservations& positions,
                                    const MatchConfig& config) {
    const auto samples = positions.samples.size();
    std::vector<BestState> chain(samples);
    if (samples == 0) {
        return chain;
    }
    Builder builder{roads, plane, routes, positions, config};
    std::vector<double> before; // weights of the first sample held
    for (std::size_t sample = 0; sample < samples; ++sample) {
        builder.add(sample);
        const bool is_last = sample + 1 == samples;
        if (!is_last && builder.held() < max_samples) {
            continue;
        }
        const auto settled = is_last ? builder.held() - 1 : builder.held() - settling_samples;
        const auto weights = posteriors(builder.lattice(), before);
        choose(chain, builder.lattice(), weights.all, builder.first(), settled, positions);
        if (!is_last) {
            const auto first = builder.lattice().first_state[settled];
            const auto past = weights.past.begin() + static_cast<std::ptrdiff_t>(first);
            const auto count = builder.lattice().first_state[settled + 1] - first;
            before.assign(past, past + static_cast<std::ptrdiff_t>(count));
            builder.drop(settled);
        }
    }
    return chain;
}

} // namespace macadam
