#pragma once

#include "mapping/style/iri_class.hpp"
#include "storage/text/unit_system.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Names of the fields of a layer.
enum class FieldNames { full, shapefile };

/// Name of a column in a Shapefile, of at most 10 bytes: "iri", "iri_inmi" for "iri_in_per_mi".
std::string_view shapefile_name(std::string_view column);

/// Style of a layer of segments for other programs: classes of `iri`, in the colours of the map,
/// with a casing; lines grow with the scale, and each direction of a road lies on its own side.
struct RoadStyle {
    const ClassTable& classes;
    UnitSystem units = UnitSystem::si; ///< of the fields
    FieldNames names = FieldNames::full;
};

/// Name of the field of a column in SI units: "iri" becomes "iri_in_per_mi" in units of the United
/// States.
/// \param unit  of the column: "mm/m"; "" = none
std::string_view field_name(const RoadStyle& style, std::string_view column, std::string_view unit);

/// Elements of a QGIS layer (QGIS 3.22): graduated renderer, labels of road names, aliases of
/// fields, map tip.
std::string qgis_layer_elements(const RoadStyle& style);

/// Style file of QGIS (.qml), of these elements.
std::string qml_style(const RoadStyle& style);

/// Styled Layer Descriptor 1.1.0 (OGC 05-078r4, symbology of 05-077r4) of the same classes and
/// colours, with widths for each zoom of web maps.
///
/// \param layer  name of the layer
std::string sld_style(const RoadStyle& style, std::string_view layer);

} // namespace macadam
