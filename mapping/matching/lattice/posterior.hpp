#pragma once

#include "mapping/matching/lattice/lattice.hpp"

namespace macadam {

/// Weights of the states of a lattice, those of each sample with the sum 1.
struct StateWeights {
    std::vector<double> past; ///< by the positions up to the state's own
    std::vector<double> all;  ///< by all positions: probabilities
};

/// Probability of each state given all positions: the forward-backward recursion, with costs
/// sharpened, because the lattice is wider than errors are so that it never loses a road.
///
/// Source: L. R. Rabiner, "A tutorial on hidden Markov models and selected applications in speech
/// recognition", Proceedings of the IEEE 77 (1989), pp. 257-286, eqs. 19 to 27.
///
/// \param before  `past` of the first sample's states, if others came before; empty: none did.
StateWeights posteriors(const Lattice& lattice, std::span<const double> before = {});

} // namespace macadam
