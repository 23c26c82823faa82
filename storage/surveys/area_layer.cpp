#include "storage/surveys/area_layer.hpp"

#include "storage/gdal/gdal_access.hpp"
#include "storage/gdal/gdal_errors.hpp"
#include "storage/gdal/layer_coordinates.hpp"

#include <ogrsf_frmts.h>

#include <utility>

namespace macadam {
namespace {

void add_polygon(const OGRPolygon& polygon,
                 LayerCoordinates& coordinates,
                 std::vector<Polygon>& polygons) {
    Polygon rings;
    for (const auto* const ring : polygon) {
        rings.push_back(coordinates.places_of(*ring));
    }
    polygons.push_back(std::move(rings));
}

void add_geometry(const OGRGeometry& geometry,
                  LayerCoordinates& coordinates,
                  std::vector<Polygon>& polygons) {
    const auto kind = wkbFlatten(geometry.getGeometryType());
    if (kind == wkbPolygon) {
        add_polygon(*geometry.toPolygon(), coordinates, polygons);
    } else if (kind == wkbMultiPolygon) {
        for (const auto* const polygon : *geometry.toMultiPolygon()) {
            add_polygon(*polygon, coordinates, polygons);
        }
    } else if (kind == wkbGeometryCollection) {
        for (const auto* const part : *geometry.toGeometryCollection()) {
            const auto kind_of_part = wkbFlatten(part->getGeometryType());
            if (kind_of_part == wkbPolygon || kind_of_part == wkbMultiPolygon) {
                add_geometry(*part, coordinates, polygons);
            }
        }
    }
}

std::vector<Polygon>
polygons_in(OGRLayer& layer, const std::filesystem::path& file, std::uintmax_t bytes) {
    LayerCoordinates coordinates{file.string(), layer, bytes};
    std::vector<Polygon> polygons;
    layer.ResetReading();
    for (;;) {
        CPLErrorReset();
        const OGRFeatureUniquePtr feature{layer.GetNextFeature()};
        if (!feature) {
            if (CPLGetLastErrorType() >= CE_Failure) {
                coordinates.fail(gdal_error("damaged"));
            }
            return polygons;
        }
        if (const auto* const geometry = feature->GetGeometryRef()) {
            add_geometry(*geometry, coordinates, polygons);
        }
    }
}

} // namespace
} // namespace macadam

extern "C" void macadam_read_area_layer(const std::filesystem::path& file,
                                        std::vector<macadam::Polygon>& polygons) {
    const macadam::GdalErrorScope quiet;
    const auto opened = macadam::open_lines(file);
    for (auto* const layer : opened.dataset->GetLayers()) {
        polygons = macadam::polygons_in(*layer, file, opened.bytes);
        if (!polygons.empty()) {
            return;
        }
    }
}
