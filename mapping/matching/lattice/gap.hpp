#pragma once

#include "mapping/matching/lattice/lattice.hpp"

#include <string>

namespace macadam {

/// A part of a trip without a road.
struct NetworkGap {
    IntervalKind kind;
    std::string reason;
};

/// Why there is no road between two samples of the chain, `to` being one past the end where the
/// trip ends so: off the network where positions show the car drive (or stand) without a road; a
/// gap where there are none.
NetworkGap hole_between(const MatchObservations& positions,
                        const std::vector<BestState>& chain,
                        std::size_t from,
                        std::size_t to,
                        const MatchConfig& config);

} // namespace macadam
