#include "storage/rasters/base_map_file.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/rasters/base_map_plugin.hpp"

#include <fmt/core.h>

namespace macadam {

BaseMap open_base_map(const std::filesystem::path& file) {
    std::error_code none;
    if (!std::filesystem::exists(file, none)) {
        throw InputError{fmt::format("{}: no such file, expected a base map", file.string())};
    }
    if (std::filesystem::is_directory(file, none)) {
        throw InputError{fmt::format("{}: is a folder, expected a base map", file.string())};
    }
    BaseMap map;
    plugin_function<BaseMapOpen>("macadam_gdal.so", base_map_open_name)(file, map);
    return map;
}

} // namespace macadam
