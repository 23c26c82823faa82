#include "storage/surveys/area_file.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/surveys/area_layer.hpp"

#include <fmt/format.h>

#include <vector>

namespace macadam {

Area read_area(const std::filesystem::path& file) {
    std::vector<Polygon> polygons;
    plugin_function<ReadAreaLayer>("macadam_gdal.so", read_area_layer_name)(file, polygons);
    Area area{polygons};
    if (is_empty(area.box())) {
        throw InputError{
            fmt::format("{}: contains no polygon, expected the outline of an area", file.string())};
    }
    return area;
}

} // namespace macadam
