#pragma once

#include "mapping/matching/lattice/lattice.hpp"

namespace macadam {

/// Weights of the states of a lattice; they sum to 1 for each sample.
struct StateWeights {
    std::vector<double> past; ///< given the positions up to the state's own
    std::vector<double> all;  ///< given all positions: posterior probabilities
};

/// Computes the probability of each state given all positions by the forward-backward recursion.
/// Costs are sharpened, because the lattice is deliberately wider than the errors.
///
/// Source: L. R. Rabiner, "A tutorial on hidden Markov models and selected applications in speech
/// recognition", Proceedings of the IEEE 77 (1989), pp. 257-286, eqs. 19 to 27.
///
/// \param before  `past` of the first sample's states if others preceded it, else empty.
StateWeights posteriors(const Lattice& lattice, std::span<const double> before = {});

} // namespace macadam
