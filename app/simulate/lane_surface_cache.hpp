#pragma once

#include "mapping/simulation/lane.hpp"

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace macadam {

/// Thread-safe cache of lane surfaces. A surface is generated on first use. When all surfaces take
/// more than `max_bytes`, the oldest are discarded and generated again, identically, on demand.
class LaneSurfaceCache {
public:
    using Make = std::function<RoadSurface(const Lane&)>;
    LaneSurfaceCache(Make make, std::size_t max_bytes)
        : make_{std::move(make)}, max_bytes_{max_bytes} {}

    std::shared_ptr<const RoadSurface> operator()(const Lane& lane);

private:
    Make make_;
    std::size_t max_bytes_;
    std::mutex mutex_;
    std::map<Lane, std::shared_ptr<const RoadSurface>> kept_;
    std::deque<Lane> age_; ///< oldest first
    std::size_t bytes_ = 0;
};

} // namespace macadam
