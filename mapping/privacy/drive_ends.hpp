#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// When a trip passed a segment, and in which block of the network that lies.
struct BlockPassage {
    std::int64_t t_ms;
    std::uint64_t block;
};

/// Which passages of a trip lie in the first or the last block of a drive; a pause of more than
/// five minutes ends a drive. What is handed on leaves them out: then it ends at the ends of
/// blocks, which the map alone decides, and never where a car's trip does.
///
/// \param passages  of one trip, in driving order.
std::vector<bool> in_end_blocks(std::span<const BlockPassage> passages);

} // namespace macadam
