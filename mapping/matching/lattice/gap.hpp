#pragma once

#include "mapping/matching/lattice/lattice.hpp"

#include <string>

namespace macadam {

/// An interval of a trip that is not on a road.
struct NetworkGap {
    IntervalKind kind;
    std::string reason;
};

/// Classifies the absence of a road between two samples of the path, where `to` is past the end if
/// the trip ends there: off the network if positions show the car driving (or standing) away from
/// roads; otherwise a gap.
NetworkGap hole_between(const MatchObservations& positions,
                        const std::vector<BestState>& chain,
                        std::size_t from,
                        std::size_t to,
                        const MatchConfig& config);

} // namespace macadam
