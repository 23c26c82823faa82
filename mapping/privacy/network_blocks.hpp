#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/network/segment.hpp"

#include <cstdint>

namespace macadam {

/// The blocks of a network: links from junction to junction in one direction, long ones cut into
/// equal parts of at most 500 m. They depend on the map alone.
class NetworkBlocks {
public:
    explicit NetworkBlocks(RoadNetwork roads) : roads_{std::move(roads)} {}

    /// A number of its own for each block. 0 for a segment that the network does not have.
    std::uint64_t block_of(const SegmentKey& segment) const;

private:
    RoadNetwork roads_;
};

} // namespace macadam
