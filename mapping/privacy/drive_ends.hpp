#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Time of a pass over a segment, and the network block of the segment.
struct BlockVisit {
    std::int64_t t_ms;
    std::uint64_t block;
};

/// Flags the passes of a trip in the first or last block of a drive; a pause of more than five
/// minutes ends a drive. Publication omits them, so that published drives end at block boundaries,
/// which depend on the map alone, and never at the ends of a trip.
///
/// \param visits  of one trip, in driving order.
std::vector<bool> in_end_blocks(std::span<const BlockVisit> visits);

} // namespace macadam
