#pragma once

#include "render/background/background_shapes.hpp"
#include "render/canvas/pdf_page.hpp"
#include "render/scene/scene.hpp"

#include <span>

namespace macadam {

/// Fills shapes on a page, all of a kind as one path, so that viewers show no seams within it.
///
/// \param shapes  sorted by kind
void draw_background(PdfPage& page, std::span<const BackgroundShape> shapes, MapStyle::Theme theme);

} // namespace macadam
