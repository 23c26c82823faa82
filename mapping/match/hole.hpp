#pragma once

#include "mapping/match/lattice.hpp"

#include <string>

namespace macadam {

/// A part of a trip without a road.
struct Hole {
    PieceKind kind;
    std::string reason;
};

/// Why there is no road between two samples of the chain, `to` being one past the end where the
/// trip ends so: off the network where positions show the car drive (or stand) without a road; a
/// gap where there are none.
Hole hole_between(const Positions& positions,
                  const std::vector<Chosen>& chain,
                  std::size_t from,
                  std::size_t to,
                  const MatchConfig& config);

} // namespace macadam
