#include "app/serve/live/tile_set.hpp"

#include "mapping/style/iri_class.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace macadam {

TileSet::TileSet(const StoreReader& store,
                 std::string version,
                 const std::filesystem::path& beside,
                 const Progress& progress)
    : version_{std::move(version)}, file_{beside} {
    TileSource source{beside};
    read_tile_source(store, {}, source, progress);
    box_ = source.box;
    const TilePlan plan{.min_zoom = min_zoom, .max_zoom = max_zoom};
    make_vector_tiles(
        source,
        *class_table(store.settings().class_table),
        plan,
        [&](const TileId& tile, std::string_view bytes) {
            places_.emplace(tile, file_.append(bytes));
        },
        progress);
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
    return place == places_.end() ? std::nullopt : std::optional{file_.read(place->second)};
}

} // namespace macadam
