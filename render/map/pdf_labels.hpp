#pragma once

#include "render/canvas/pdf_page.hpp"
#include "render/labels/label_painter.hpp"

#include <span>

namespace macadam {

/// Writes labels on a page: the same letters at the same positions as draw_labels draws on a
/// picture, but as searchable and copyable text.
void draw_labels(PdfPage& page,
                 std::span<const Label> labels,
                 const LabelInks& inks,
                 const TypeSetter& setter);

} // namespace macadam
