#include "app/simulate/lane_surface_cache.hpp"

#include <utility>

namespace macadam {
namespace {

std::size_t bytes_of(const RoadSurface& surface) {
    std::size_t bytes = sizeof surface;
    for (const auto& line : surface.elevation_m) {
        bytes += line.size() * sizeof line.front();
    }
    return bytes;
}

} // namespace

std::shared_ptr<const RoadSurface> LaneSurfaceCache::operator()(const Lane& lane) {
    {
        const std::scoped_lock lock{mutex_};
        if (const auto found = kept_.find(lane); found != kept_.end()) {
            return found->second;
        }
    }
    // Two threads may generate the same surface: that is cheaper than waiting for each other.
    auto made = std::make_shared<const RoadSurface>(make_(lane));
    const std::scoped_lock lock{mutex_};
    const auto [at, fresh] = kept_.emplace(lane, std::move(made));
    const auto surface = at->second;
    if (fresh) {
        age_.push_back(lane);
        bytes_ += bytes_of(*surface);
    }
    while (bytes_ > max_bytes_ && age_.size() > 1) {
        const auto oldest = kept_.find(age_.front());
        bytes_ -= bytes_of(*oldest->second);
        kept_.erase(oldest);
        age_.pop_front();
    }
    return surface;
}

} // namespace macadam
