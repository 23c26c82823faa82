#include "render/map/pdf_background.hpp"

#include "render/background/background_painter.hpp"

#include <vector>

namespace macadam {

void draw_background(PdfPage& page,
                     std::span<const BackgroundShape> shapes,
                     MapStyle::Theme theme) {
    std::vector<std::span<const PixelPoint>> rings;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        rings.insert(rings.end(), shapes[i].rings.begin(), shapes[i].rings.end());
        if (i + 1 == shapes.size() || shapes[i + 1].kind != shapes[i].kind) {
            page.fill_rings(rings, background_colour(shapes[i].kind, theme));
            rings.clear();
        }
    }
}

} // namespace macadam
