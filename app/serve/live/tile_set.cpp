#include "app/serve/live/tile_set.hpp"

#include <algorithm>
#include <utility>

namespace macadam {

TileSet::TileSet(std::string version,
                 std::string layers,
                 const GeoBox& box,
                 std::shared_ptr<const TempFile> file,
                 Places places)
    : version_{std::move(version)}, layers_{std::move(layers)}, box_{box}, file_{std::move(file)},
      places_{std::move(places)} {
    if (places_.empty()) {                     // no box is around nothing
        constexpr double lat_deg = 85.0511288; // of Web Mercator
        box_ = {-180, -lat_deg, 180, lat_deg};
    }
    constexpr double least_deg = 1e-6; // 0.1 m: clients take no box without a width or height
    box_.east_deg = std::max(box_.east_deg, box_.west_deg + least_deg);
    box_.north_deg = std::max(box_.north_deg, box_.south_deg + least_deg);
}

std::optional<std::string> TileSet::tile(const TileId& id) const {
    const auto place = places_.find(id);
    return place == places_.end() ? std::nullopt : std::optional{file_->read(place->second)};
}

} // namespace macadam
