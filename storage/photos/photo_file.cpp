#include "storage/photos/photo_file.hpp"

#include "estimator/common/plugin_library.hpp"
#include "storage/photos/photo_plugin.hpp"

#include <cassert>

namespace macadam {

PhotoPlace read_photo_place(const std::filesystem::path& file) {
    PhotoPlace place;
    plugin_function<PhotoPlaceRead>("macadam_gdal.so", photo_place_read_name)(file, place);
    return place;
}

SmallPhoto reduce_photo(const std::filesystem::path& file, int max_px) {
    assert(16 <= max_px && max_px <= 4096);
    SmallPhoto photo;
    plugin_function<PhotoReduce>("macadam_gdal.so", photo_reduce_name)(file, max_px, photo);
    return photo;
}

} // namespace macadam
