#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/network/segment.hpp"

#include <cstdint>

namespace macadam {

/// Blocks of a network: links between junctions in one direction, long ones cut into equal parts of
/// at most 500 m. They depend on the map alone.
class NetworkBlocks {
public:
    explicit NetworkBlocks(RoadNetwork roads) : roads_{std::move(roads)} {}

    /// Returns a unique number for each block; 0 for a segment that the network does not have.
    std::uint64_t block_of(const SegmentKey& segment) const;

private:
    RoadNetwork roads_;
};

} // namespace macadam
