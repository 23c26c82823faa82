#pragma once

#include "render/canvas/pdf_page.hpp"
#include "render/scene/scene.hpp"

#include <string>

namespace macadam {

/// Returns the map as the bytes of a PDF file, with vector lines and text. Its layout equals that
/// of render_map on a picture of the sheet's pixels.
///
/// \throws InputError  as render_map, and if Cairo cannot write it.
std::string map_pdf(const MapScene& scene, const MapStyle& style, const PdfSheet& sheet);

} // namespace macadam
