#include "storage/gdal/layer_coordinates.hpp"

#include "estimator/common/error.hpp"
#include "storage/gdal/coordinate_system.hpp"
#include "storage/gdal/gdal_errors.hpp"

#include <fmt/core.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <utility>

namespace macadam {
namespace {

/// Maximum number of points per byte, for formats that store an arc in a few bytes and expand it to
/// points.
constexpr std::uintmax_t max_points_per_byte = 4;

/// Rounds to 1e-9 degrees (0.1 mm). PROJ calls the sines of libm, whose last bits depend on the
/// processor; networks, and by them the digest, must not.
double rounded(double deg) {
    constexpr double per_degree = 1e9;
    return std::round(deg * per_degree) / per_degree;
}

/// Maximum absolute coordinate in the units of any map. GDAL wraps an x of spherical Mercator one
/// revolution at a time, which would never end for huge values.
constexpr double farthest = 1e10;

} // namespace

void LayerCoordinates::Free::operator()(OGRCoordinateTransformation* transformation) const {
    OGRCoordinateTransformation::DestroyCT(transformation);
}

LayerCoordinates::LayerCoordinates(std::string file, OGRLayer& layer, std::uintmax_t bytes)
    : file_{std::move(file)}, layer_{layer}, points_left_{max_points_per_byte * bytes} {
    auto* const system = layer.GetSpatialRef();
    if (system == nullptr) {
        return; // invalid degrees are detected below
    }
    expect_grids_of_proj(*system, file_);
    OGRSpatialReference wgs84;
    wgs84.importFromEPSG(4326);
    wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    system->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to_wgs84_.reset(OGRCreateCoordinateTransformation(system, &wgs84));
    if (!to_wgs84_) {
        fail(fmt::format("its coordinates cannot be converted: {}", gdal_error("not known")));
    }
}

void LayerCoordinates::fail(const std::string& what) const {
    throw InputError{fmt::format("{}: layer '{}': {}", file_, layer_.GetName(), what)};
}

std::vector<GeoPoint> LayerCoordinates::places_of(const OGRSimpleCurve& line) {
    const auto count = static_cast<std::uintmax_t>(line.getNumPoints());
    if (count > points_left_) {
        fail("has more points than bytes, expected a plain map file");
    }
    points_left_ -= count;
    std::vector<GeoPoint> places;
    for (int i = 0; i < line.getNumPoints(); ++i) {
        double lon_deg = line.getX(i);
        double lat_deg = line.getY(i);
        const bool is_near = std::abs(lon_deg) <= farthest && std::abs(lat_deg) <= farthest;
        if (to_wgs84_ && !(is_near && to_wgs84_->Transform(1, &lon_deg, &lat_deg))) {
            fail(fmt::format("{}, {} cannot be converted to degrees", line.getX(i), line.getY(i)));
        }
        if (to_wgs84_) {
            lon_deg = rounded(lon_deg);
            lat_deg = rounded(lat_deg);
        }
        if (!(std::abs(lat_deg) <= 90 && std::abs(lon_deg) <= 180)) {
            fail(fmt::format(
                "{}, {} is not a valid position in degrees", line.getX(i), line.getY(i)));
        }
        places.push_back({lat_deg, lon_deg});
    }
    return places;
}

} // namespace macadam
