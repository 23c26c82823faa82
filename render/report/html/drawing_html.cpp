#include "render/report/html/drawing_html.hpp"

#include "render/report/document/html.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>

namespace macadam::document {
namespace {

std::string svg_of(const Stroke& stroke) {
    const auto* const look = stroke.look == StrokeLook::mean ? "mean" : "grid";
    if (stroke.points.size() == 2) {
        const auto& [from, to] = std::pair{stroke.points[0], stroke.points[1]};
        return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" "
                           "y2=\"{:.1f}\"/>\n",
                           look,
                           from.first,
                           from.second,
                           to.first,
                           to.second);
    }
    std::string points;
    for (const auto& [x, y] : stroke.points) {
        points += fmt::format("{:.1f},{:.1f} ", x, y);
    }
    return fmt::format("<polyline points=\"{}\" fill=\"none\" class=\"{}\" "
                       "stroke-width=\"1.5\"/>\n",
                       points,
                       look);
}

/// Ends a shape, with words that appear under the pointer.
std::string shape_end(const std::string& words) {
    return words.empty() ? "/>\n" : fmt::format("><title>{}</title></rect>\n", escaped(words));
}

std::string svg_of(const Bar& bar) {
    return fmt::format("<rect{} x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                       "fill=\"#{:06x}\"",
                       bar.edged ? " class=\"bar\"" : "",
                       bar.x,
                       bar.y,
                       bar.width,
                       bar.height,
                       bar.rgb) +
           shape_end(bar.words);
}

std::string svg_of(const Band& band) {
    return fmt::format("<rect class=\"band\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                       "height=\"{:.2f}\"",
                       band.x,
                       band.y,
                       band.width,
                       band.height) +
           shape_end(band.words);
}

std::string svg_of(const Label& label) {
    const auto* const anchor = label.anchor == Anchor::start    ? "start"
                               : label.anchor == Anchor::middle ? "middle"
                                                                : "end";
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                       label.x,
                       label.y,
                       anchor,
                       escaped(label.text));
}

std::string svg_of(const Dots& dots) {
    std::string path;
    for (const auto& [x, y] : dots.places) {
        path += fmt::format("M{:g} {:g}h0", x, y);
    }
    return fmt::format("<path d=\"{}\" stroke=\"#{:06x}\" stroke-width=\"{:g}\" "
                       "stroke-linecap=\"round\" stroke-opacity=\"0.6\" fill=\"none\"/>\n",
                       path,
                       dots.rgb,
                       dots.width);
}

} // namespace

std::string block_html(const Drawing& drawing) {
    constexpr double widest_of_columns = 500; // wider drawings take the page's width
    const bool is_wide = drawing.width > widest_of_columns;
    auto svg = fmt::format("<svg class=\"{}\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" "
                           "font-size=\"12\" aria-label=\"{}\">\n",
                           is_wide ? "strip" : "histogram",
                           drawing.width,
                           drawing.height,
                           escaped(drawing.words));
    for (const auto& shape : drawing.shapes) {
        svg += std::visit([](const auto& of) { return svg_of(of); }, shape);
    }
    svg += "</svg>\n";
    return is_wide ? fmt::format("<div class=\"wide\" role=\"region\" aria-label=\"{}\" "
                                 "tabindex=\"0\">{}</div>\n",
                                 escaped(drawing.words),
                                 svg)
                   : svg;
}

} // namespace macadam::document
