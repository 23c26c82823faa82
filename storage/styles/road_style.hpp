#pragma once

#include "mapping/style/iri_class.hpp"

#include <string>
#include <string_view>

namespace macadam {

// Style of a layer of segments for other programs: classes of `iri` in mm/m, in the colours of the
// map, with a casing; lines grow with the scale, and each direction of a road lies on its own side.

/// Elements of a QGIS layer (QGIS 3.22): graduated renderer, labels of road names, aliases of
/// fields, map tip.
std::string qgis_layer_elements(const ClassTable& classes);

/// Style file of QGIS (.qml), of these elements.
std::string qml_style(const ClassTable& classes);

/// Styled Layer Descriptor 1.1.0 (OGC 05-078r4, symbology of 05-077r4) of the same classes and
/// colours, with widths for four ranges of scale.
///
/// \param layer  name of the layer
std::string sld_style(const ClassTable& classes, std::string_view layer);

} // namespace macadam
