#pragma once

#include "render/canvas/pdf_page.hpp"
#include "render/scene/scene.hpp"

#include <string>

namespace macadam {

/// The same map as render_map draws on a picture of the sheet's pixels, as the bytes of a PDF file:
/// its lines are lines and its text is text.
///
/// \throws InputError  as render_map, and if Cairo cannot write it.
std::string map_pdf(const MapScene& scene, const MapStyle& style, const PdfSheet& sheet);

} // namespace macadam
