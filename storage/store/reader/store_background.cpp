#include "storage/store/reader/store_background.hpp"

#include "storage/store/connection/store_connection.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <system_error>

namespace macadam {

StoreBackground::StoreBackground(const StoreReader& store) {
    std::error_code none;
    if (std::filesystem::is_regular_file(store.file(), none)) {
        store_ = open_connection(store.file(), Database::Access::read, {}, Audience::anyone);
    }
}

std::vector<BackgroundTile> StoreBackground::tiles(const BackgroundLevel& level,
                                                   const GeoBox& box) const {
    return store_ ? read_background_tiles(store_->database, level, box)
                  : std::vector<BackgroundTile>{};
}

std::vector<PlaceName> StoreBackground::places(const GeoBox& box) const {
    return store_ ? read_place_names(store_->database, box) : std::vector<PlaceName>{};
}

std::vector<RoadRef> StoreBackground::road_refs() const {
    return store_ ? read_road_refs(store_->database) : std::vector<RoadRef>{};
}

BackgroundSize StoreBackground::size() const {
    return store_ ? background_size(store_->database) : BackgroundSize{};
}

} // namespace macadam
