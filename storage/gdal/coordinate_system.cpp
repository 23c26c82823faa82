#include "storage/gdal/coordinate_system.hpp"

#include "estimator/common/error.hpp"

#include <cpl_conv.h>
#include <fmt/core.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace macadam {
namespace {

std::string wkt_of(const OGRSpatialReference& system, const char* version) {
    const std::string format = std::string{"FORMAT="} + version;
    const std::array<const char*, 2> options{format.c_str(), nullptr};
    char* text = nullptr;
    system.exportToWkt(&text, options.data());
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

bool is_path(std::string_view name) {
    return name.find_first_of("/\\") != name.npos;
}

/// Finds paths in values of PROJ strings ("+nadgrids=@a.gsb,b.gsb") inside WKT.
bool names_path_in_proj_string(std::string_view wkt) {
    for (auto at = wkt.find('='); at != wkt.npos; at = wkt.find('=', at + 1)) {
        if (is_path(wkt.substr(at, wkt.find_first_of(" \"", at) - at))) {
            return true;
        }
    }
    return false;
}

/// Finds paths in PARAMETERFILE["Latitude and longitude difference file","a.gsb"].
bool names_path_in_parameter(std::string_view wkt) {
    constexpr std::string_view word = "PARAMETERFILE[";
    for (auto at = wkt.find(word); at != wkt.npos; at = wkt.find(word, at + 1)) {
        const auto inside = wkt.substr(at, wkt.find(']', at) - at);
        if (is_path(inside.substr(std::min(inside.size(), inside.find(','))))) {
            return true;
        }
    }
    return false;
}

} // namespace

void expect_grids_of_proj(const OGRSpatialReference& system, const std::string& file) {
    for (const auto* const version : {"WKT1_GDAL", "WKT2_2019"}) {
        auto wkt = wkt_of(system, version);
        if (names_path_in_proj_string(wkt) || names_path_in_parameter(wkt)) {
            throw InputError{
                fmt::format("{}: its coordinate system names a grid file by its path, expected "
                            "one that PROJ knows; assign another with gdal_translate or "
                            "ogr2ogr -a_srs EPSG:...",
                            file)};
        }
    }
}

} // namespace macadam
