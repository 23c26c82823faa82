#pragma once

#include "render/canvas/pdf_page.hpp"
#include "render/labels/label_painter.hpp"

#include <span>

namespace macadam {

/// Labels on a page: the same letters at the same places as draw_labels draws on a picture, but as
/// text that can be searched and copied.
void draw_labels(PdfPage& page,
                 std::span<const Label> labels,
                 const LabelInks& inks,
                 const TypeSetter& setter);

} // namespace macadam
