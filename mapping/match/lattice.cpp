#include "mapping/match/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace macadam {
namespace {

constexpr double off_switch_nats = 6; // leaving the network, and coming back
constexpr double gap_nats = 25;       // going on elsewhere: more than any credible detour
constexpr double beam_nats = 15;      // behind the best by more: not followed
constexpr std::size_t widest_beam = 12;
constexpr std::size_t widest_far_beam = 5; // where each needs a long search
constexpr double far_m = 1000;

constexpr double evidence_share = 3; // the lattice is about three times as wide as errors are

constexpr double never = std::numeric_limits<double>::infinity();

struct Transition {
    std::uint32_t from; ///< states of the whole lattice
    std::uint32_t to;
    float cost;
    bool joined;
};

struct State {
    Candidate candidate;
    double cost;           ///< of the cheapest chain up to here, its own included
    std::uint32_t arrival; ///< the transition of that chain
};

/// One range of states and one of transitions into them for each sample.
struct Lattice {
    std::vector<State> states;
    std::vector<Transition> transitions;
    std::vector<std::size_t> first_state; ///< per sample + 1
    std::vector<std::size_t> first_transition;

    std::span<const State> states_of(std::size_t sample) const {
        return std::span{states}.subspan(first_state[sample],
                                         first_state[sample + 1] - first_state[sample]);
    }
    std::span<const Transition> into(std::size_t sample) const {
        return std::span{transitions}.subspan(
            first_transition[sample], first_transition[sample + 1] - first_transition[sample]);
    }
};

double distance_nats(double distance_m, double sd_m) {
    const double sds = distance_m / sd_m;
    return sds * sds / 2;
}

/// Von Mises: quadratic like a normal distribution for small angles, bounded for large ones.
double course_nats(double angle_rad, const MatchConfig& config) {
    const double sd_rad = config.course_sd_deg * std::numbers::pi / 180;
    return (1 - std::cos(angle_rad)) / (sd_rad * sd_rad);
}

void add_candidates(std::vector<State>& states,
                    const RoadNetwork& roads,
                    const std::vector<NearPlace>& places,
                    const Position& position,
                    const MatchConfig& config) {
    const auto first = states.size();
    const auto full = [&] {
        return states.size() - first >= static_cast<std::size_t>(config.most_candidates);
    };
    for (const auto& place : places) {
        for (const bool forward : {true, false}) {
            const auto edge = edge_of(place.link, forward);
            if (full() || !is_drivable(roads, edge)) {
                continue;
            }
            double cost = distance_nats(place.distance_m, position.sd_m);
            if (!std::isnan(position.course_rad)) {
                const double course_rad = place.course_rad + (forward ? 0.0 : std::numbers::pi);
                cost += course_nats(position.course_rad - course_rad, config);
            }
            const double offset_m = forward ? place.along_m : length_m(roads, edge) - place.along_m;
            states.push_back({{false, edge, offset_m, static_cast<float>(cost)}, never, 0});
        }
    }
    const double off = distance_nats(config.off_network_m, position.sd_m);
    states.push_back({{true, EdgeId{}, 0, static_cast<float>(off)}, never, 0});
}

/// States of a sample that are worth following, the best first.
std::vector<std::uint32_t>
survivors(const Lattice& lattice, std::size_t sample, std::size_t widest) {
    std::vector<std::uint32_t> order(lattice.first_state[sample + 1] - lattice.first_state[sample]);
    std::iota(order.begin(), order.end(), static_cast<std::uint32_t>(lattice.first_state[sample]));
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return lattice.states[a].cost < lattice.states[b].cost;
    });
    const double worst = lattice.states[order.front()].cost + beam_nats;
    const auto end = std::find_if(order.begin(), order.end(), [&](std::uint32_t state) {
        return lattice.states[state].cost > worst;
    });
    order.erase(end, order.end());
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
            RoadPlane& plane,
            Routes& routes,
            const Positions& positions,
            const MatchConfig& config)
        : roads_{roads}, plane_{plane}, routes_{routes}, positions_{positions}, config_{config} {}

    Lattice build() && {
        for (std::size_t sample = 0; sample < positions_.samples.size(); ++sample) {
            add_states(sample);
            if (sample > 0) {
                add_transitions(sample);
            }
            lattice_.first_transition.push_back(lattice_.transitions.size());
        }
        return std::move(lattice_);
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
                       position,
                       config_);
        lattice_.first_state.push_back(lattice_.states.size());
        if (sample == 0) {
            for (auto i = first; i < lattice_.states.size(); ++i) {
                lattice_.states[i].cost = lattice_.states[i].candidate.cost;
            }
        }
    }

    void add_transitions(std::size_t sample) {
        const auto between =
            between_samples(positions_, positions_.samples[sample - 1], positions_.samples[sample]);
        const bool far = between.travelled_m > far_m;
        const auto from = survivors(lattice_, sample - 1, far ? widest_far_beam : widest_beam);
        const auto targets = edges_of(lattice_.states_of(sample));
        for (const auto state : from) {
            leave(state, sample, targets, between, state == from.front());
        }
    }

    void leave(std::uint32_t from,
               std::size_t sample,
               const std::vector<EdgeId>& targets,
               const Between& between,
               bool best) {
        const auto candidate = lattice_.states[from].candidate;
        const auto* reached =
            candidate.off_network
                ? nullptr
                : &reached_from(routes_, candidate.edge, targets, between, config_);
        const auto last = static_cast<std::uint32_t>(lattice_.states.size());
        for (auto to = static_cast<std::uint32_t>(lattice_.first_state[sample]); to < last; ++to) {
            const auto& target = lattice_.states[to].candidate;
            if (candidate.off_network || target.off_network) {
                const bool stays = candidate.off_network && target.off_network;
                add({from, to, stays ? 0 : static_cast<float>(off_switch_nats), false});
                continue;
            }
            const auto passage = passage_of(roads_, *reached, candidate, target, between, config_);
            if (passage) {
                const double cost = cost_of(*passage, between, config_);
                if (cost < gap_nats) {
                    add({from, to, static_cast<float>(cost), true});
                }
            }
            if (best) {
                add({from, to, static_cast<float>(gap_nats), false});
            }
        }
    }

    void add(const Transition& transition) {
        auto& to = lattice_.states[transition.to];
        const double cost =
            lattice_.states[transition.from].cost + transition.cost + to.candidate.cost;
        if (cost < to.cost) {
            to.cost = cost;
            to.arrival = static_cast<std::uint32_t>(lattice_.transitions.size());
        }
        lattice_.transitions.push_back(transition);
    }

    const RoadNetwork& roads_;
    RoadPlane& plane_;
    Routes& routes_;
    const Positions& positions_;
    const MatchConfig& config_;
    Lattice lattice_;
};

// ---------------------------------------------------------------------------------- posterior

double weight(double cost) {
    return std::exp(-evidence_share * cost);
}

void scale_to_one(std::vector<double>& values, std::size_t first, std::size_t last) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(last);
    const double sum = std::accumulate(begin, end, 0.0);
    if (sum > 0) {
        std::for_each(begin, end, [&](double& value) { value /= sum; });
    }
}

/// Per sample, the least cost of its candidates: what all share says nothing about any.
std::vector<double> floors(const Lattice& lattice, std::size_t samples) {
    std::vector<double> least(samples, never);
    for (std::size_t sample = 0; sample < samples; ++sample) {
        for (const auto& state : lattice.states_of(sample)) {
            least[sample] = std::min(least[sample], static_cast<double>(state.candidate.cost));
        }
    }
    return least;
}

std::vector<double> state_weights(const Lattice& lattice, std::size_t samples) {
    const auto floor = floors(lattice, samples);
    std::vector<double> weights(lattice.states.size());
    for (std::size_t sample = 0; sample < samples; ++sample) {
        for (auto i = lattice.first_state[sample]; i < lattice.first_state[sample + 1]; ++i) {
            weights[i] = weight(lattice.states[i].candidate.cost - floor[sample]);
        }
    }
    return weights;
}

/// Probability of each state given all positions (the forward-backward recursion).
std::vector<double> posteriors(const Lattice& lattice, std::size_t samples) {
    const auto own = state_weights(lattice, samples);
    std::vector<double> step(lattice.transitions.size());
    for (std::size_t i = 0; i < step.size(); ++i) {
        step[i] = weight(lattice.transitions[i].cost);
    }
    std::vector<double> forward(own.size(), 0.0);
    std::vector<double> backward(own.size(), 0.0);
    for (std::size_t sample = 0; sample < samples; ++sample) {
        for (auto i = lattice.first_transition[sample]; i < lattice.first_transition[sample + 1];
             ++i) {
            const auto& way = lattice.transitions[i];
            forward[way.to] += forward[way.from] * step[i];
        }
        for (auto i = lattice.first_state[sample]; i < lattice.first_state[sample + 1]; ++i) {
            forward[i] = (sample == 0 ? 1 : forward[i]) * own[i];
        }
        scale_to_one(forward, lattice.first_state[sample], lattice.first_state[sample + 1]);
    }
    std::fill(backward.begin() + static_cast<std::ptrdiff_t>(lattice.first_state[samples - 1]),
              backward.end(),
              1.0);
    for (std::size_t sample = samples - 1; sample > 0; --sample) {
        for (auto i = lattice.first_transition[sample]; i < lattice.first_transition[sample + 1];
             ++i) {
            const auto& way = lattice.transitions[i];
            backward[way.from] += backward[way.to] * own[way.to] * step[i];
        }
        scale_to_one(backward, lattice.first_state[sample - 1], lattice.first_state[sample]);
    }
    for (std::size_t sample = 0; sample < samples; ++sample) {
        for (auto i = lattice.first_state[sample]; i < lattice.first_state[sample + 1]; ++i) {
            forward[i] *= backward[i];
        }
        scale_to_one(forward, lattice.first_state[sample], lattice.first_state[sample + 1]);
    }
    return forward;
}

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

} // namespace

std::vector<Chosen> cheapest_chain(const RoadNetwork& roads,
                                   RoadPlane& plane,
                                   Routes& routes,
                                   const Positions& positions,
                                   const MatchConfig& config) {
    const auto samples = positions.samples.size();
    std::vector<Chosen> chain(samples);
    if (samples == 0) {
        return chain;
    }
    const auto lattice = Builder{roads, plane, routes, positions, config}.build();
    const auto posterior = posteriors(lattice, samples);
    const auto last = lattice.states_of(samples - 1);
    auto at = static_cast<std::size_t>(
        std::min_element(last.begin(),
                         last.end(),
                         [](const State& a, const State& b) { return a.cost < b.cost; }) -
        last.begin() + static_cast<std::ptrdiff_t>(lattice.first_state[samples - 1]));
    for (auto sample = samples; sample-- > 0;) {
        const auto& state = lattice.states[at];
        chain[sample] = {positions.samples[sample],
                         state.candidate,
                         sample > 0 && lattice.transitions[state.arrival].joined,
                         confidence_of(lattice, posterior, sample, state.candidate)};
        at = sample > 0 ? lattice.transitions[state.arrival].from : 0;
    }
    return chain;
}

} // namespace macadam
