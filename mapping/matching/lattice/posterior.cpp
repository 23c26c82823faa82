
#include "mapping/matching/lattice/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace macadam {
namespace {

constexpr double evidence_share = 3; // the lattice is about three times as wide as the errors

struct Range {
    std::size_t first;
    std::size_t last;
};

Range states_of(const Lattice& lattice, std::size_t sample) {
    return {lattice.first_state[sample], lattice.first_state[sample + 1]};
}

Range into(const Lattice& lattice, std::size_t sample) {
    return {lattice.first_transition[sample], lattice.first_transition[sample + 1]};
}

double weight(double cost) {
    return std::exp(-evidence_share * cost);
}

void scale_to_one(std::vector<double>& values, const Range& range) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(range.first);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(range.last);
    const double sum = std::accumulate(begin, end, 0.0);
    if (sum > 0) {
        std::for_each(begin, end, [&](double& value) { value /= sum; });
    }
}

/// Costs are relative to the minimum of each sample, as a cost common to all its candidates carries
/// no information.
std::vector<double> state_weights(const Lattice& lattice, std::size_t samples) {
    std::vector<double> weights(lattice.states.size());
    for (std::size_t sample = 0; sample < samples; ++sample) {
        auto least = std::numeric_limits<float>::infinity();
        for (const auto& state : lattice.states_of(sample)) {
            least = std::min(least, state.candidate.cost);
        }
        const auto range = states_of(lattice, sample);
        for (auto i = range.first; i < range.last; ++i) {
            weights[i] = weight(static_cast<double>(lattice.states[i].candidate.cost - least));
        }
    }
    return weights;
}

} // namespace

StateWeights posteriors(const Lattice& lattice, std::span<const double> before) {
    const auto samples = lattice.first_state.size() - 1;
    const auto own = state_weights(lattice, samples);
    std::vector<double> step(lattice.transitions.size());
    std::transform(lattice.transitions.begin(),
                   lattice.transitions.end(),
                   step.begin(),
                   [](const LatticeArc& way) { return weight(static_cast<double>(way.cost)); });
    std::vector<double> forward(own.size(), 0.0);
    std::vector<double> backward(own.size(), 1.0);
    for (std::size_t sample = 0; sample < samples; ++sample) {
        const auto ways = into(lattice, sample);
        for (auto i = ways.first; i < ways.last; ++i) {
            const auto& way = lattice.transitions[i];
            forward[way.to] += forward[way.from] * step[i];
        }
        const auto states = states_of(lattice, sample);
        for (auto i = states.first; i < states.last; ++i) {
            forward[i] = sample > 0 ? forward[i] * own[i] : before.empty() ? own[i] : before[i];
        }
        scale_to_one(forward, states);
    }
    for (std::size_t sample = samples - 1; sample > 0; --sample) {
        const auto earlier = states_of(lattice, sample - 1);
        std::fill(backward.begin() + static_cast<std::ptrdiff_t>(earlier.first),
                  backward.begin() + static_cast<std::ptrdiff_t>(earlier.last),
                  0.0);
        const auto ways = into(lattice, sample);
        for (auto i = ways.first; i < ways.last; ++i) {
            const auto& way = lattice.transitions[i];
            backward[way.from] += backward[way.to] * own[way.to] * step[i];
        }
        scale_to_one(backward, earlier);
    }
    auto past = forward;
    for (std::size_t sample = 0; sample < samples; ++sample) {
        const auto states = states_of(lattice, sample);
        for (auto i = states.first; i < states.last; ++i) {
            forward[i] *= backward[i];
        }
        scale_to_one(forward, states);
    }
    return {std::move(past), std::move(forward)};
}

} // namespace macadam
