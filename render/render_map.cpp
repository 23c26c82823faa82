#include "render/map.hpp"

#include "estimator/common/error.hpp"
#include "render/furniture.hpp"
#include "render/label_painter.hpp"
#include "render/line_joining.hpp"
#include "render/map_labels.hpp"
#include "render/pdf_map.hpp"
#include "render/pdf_roads.hpp"
#include "render/road_painter.hpp"
#include "render/road_strands.hpp"

#include <fmt/core.h>

#include <cmath>

namespace macadam {
namespace {

void check_size(int width_px, int height_px) {
    for (const int side_px : {width_px, height_px}) {
        if (side_px < least_image_px || side_px > most_image_px) {
            throw InputError{fmt::format("picture size '{}x{}', expected sides of {} to {} px",
                                         width_px,
                                         height_px,
                                         least_image_px,
                                         most_image_px)};
        }
    }
}

const ClassTable& classes_of(const MapStyle& style) {
    return style.classes != nullptr ? *style.classes : *class_table("fhwa");
}

void check_classes(const MapScene& scene, const ClassTable& table) {
    if (table.classes.empty() || table.classes.size() > most_classes) {
        throw InputError{fmt::format("table '{}' has {} classes, expected 1 to {}",
                                     table.name,
                                     table.classes.size(),
                                     most_classes)};
    }
    const int last = int(table.classes.size()) - 1;
    for (const auto& line : scene.lines) {
        if (line.iri_class < -1 || line.iri_class > last) {
            throw InputError{fmt::format("a line of class '{}', expected -1 to {} as in table '{}'",
                                         line.iri_class,
                                         last,
                                         table.name)};
        }
    }
}

std::vector<Strand>
strands_of(const MapScene& scene, const std::vector<LineUse>& uses, const MapFrame& frame) {
    std::vector<Strand> strands;
    for (const auto& chain : joined(scene.lines, uses)) {
        auto strand = strand_of(scene.lines, chain, frame);
        if (!strand.looks.empty()) {
            strands.push_back(std::move(strand));
        }
    }
    return strands;
}

/// The scene with lines that bend as the projection bends them.
MapScene bent_scene(const MapScene& scene, const MapFrame& frame) {
    auto shown = scene;
    for (auto& line : shown.lines) {
        line.line = bent(frame, line.line);
    }
    return shown;
}

struct Roads {
    std::vector<Strand> strands;
    LineWidths widths;
};

/// Each of two ways at its side of the road.
std::vector<Strand> side_by_side(const MapScene& scene,
                                 const MapStyle& style,
                                 const MapFrame& frame,
                                 const LineWidths& widths) {
    std::vector<LineUse> alone;
    std::vector<LineUse> paired;
    for (const auto& use : all_lines(scene.lines)) {
        const auto& line = scene.lines[use.line];
        (line.both_ways && line.iri_class >= 0 ? paired : alone).push_back(use);
    }
    auto strands = strands_of(scene, alone, frame);
    for (const auto& strand : strands_of(scene, paired, frame)) {
        const double right_px = way_offset_px(widths, strand.rank);
        strands.push_back(beside(strand, style.left_hand_traffic ? -right_px : right_px));
    }
    return strands;
}

Roads roads_of(const MapScene& scene,
               const MapStyle& style,
               const MapFrame& frame,
               const Layout& layout) {
    const double middle_px = (layout.map.top + layout.map.bottom) / 2;
    auto wanted = line_widths(metres_per_px(frame, middle_px), layout.unit);
    wanted.core_px *= style.lines.width;
    wanted.casing_px *= style.lines.casing;
    auto merged = strands_of(scene, worse_of_both_ways(scene.lines), frame);
    const double ink = ink_per_px(merged, layout.map, layout.unit);
    if (!wanted.separate_ways) {
        return {std::move(merged), uncrowded(wanted, ink, layout.unit)};
    }
    const auto separate = uncrowded(wanted, 2 * ink, layout.unit);
    if (separate.separate_ways) {
        return {side_by_side(scene, style, frame, separate), separate};
    }
    return {std::move(merged), uncrowded(wanted, ink, layout.unit)};
}

Roads shown_roads(const MapScene& scene,
                  const MapStyle& style,
                  const MapFrame& frame,
                  const Layout& layout) {
    return scene.projection ? roads_of(bent_scene(scene, frame), style, frame, layout)
                            : roads_of(scene, style, frame, layout); // without a copy of all lines
}

MapFrame frame_of(const MapScene& scene, const MapStyle& style, int width_px, int height_px) {
    check_size(width_px, height_px);
    TypeSetter setter;
    const auto layout = layout_of(scene, width_px, height_px, setter);
    const auto legend = legend_of(scene, style, classes_of(style));
    return placement_of(scene, legend, layout, setter).frame;
}

Image with_labels(Image roads,
                  std::span<const Label> labels,
                  const Palette& colours,
                  TypeSetter& setter) {
    Canvas canvas{std::move(roads)};
    draw_labels(canvas, labels, {}, {colours.ink, colours.quiet_ink, colours.ground}, setter);
    return std::move(canvas).finished();
}

} // namespace

Image render_map(const MapScene& scene, const MapStyle& style, int width_px, int height_px) {
    check_size(width_px, height_px);
    const auto& classes = classes_of(style);
    check_classes(scene, classes);
    const auto colours = class_colours(style, classes.classes.size());

    TypeSetter setter;
    const auto layout = layout_of(scene, width_px, height_px, setter);
    const auto legend = legend_of(scene, style, classes);
    const auto placement = placement_of(scene, legend, layout, setter);
    const auto roads = shown_roads(scene, style, placement.frame, layout);
    auto image = painted_roads(
        {width_px, height_px, layout.map}, roads.strands, roads.widths, palette(style), colours);
    if (style.labels) {
        const auto labels = map_labels(scene, layout, placement, roads.widths, setter);
        image = with_labels(std::move(image), labels, palette(style), setter);
    }
    return furnished(std::move(image), layout, placement, style, setter);
}

std::string map_pdf(const MapScene& scene, const MapStyle& style, const PdfSheet& sheet) {
    const int width_px = int(std::lround(sheet.width_px));
    const int height_px = int(std::lround(sheet.height_px));
    check_size(width_px, height_px);
    const auto& classes = classes_of(style);
    check_classes(scene, classes);
    const auto colours = class_colours(style, classes.classes.size());
    const auto theme = palette(style);

    TypeSetter setter;
    const auto layout = layout_of(scene, width_px, height_px, setter);
    const auto legend = legend_of(scene, style, classes);
    const auto placement = placement_of(scene, legend, layout, setter);
    const auto roads = shown_roads(scene, style, placement.frame, layout);
    return pdf_file(sheet, [&](PdfPage& page) {
        page.fill({{0, 0, sheet.width_px, sheet.height_px}}, theme.page);
        page.fill({layout.map}, theme.ground);
        page.begin_clip(layout.map);
        draw_roads(page, roads.strands, roads.widths, theme, colours);
        page.end_clip();
        furnish(page, layout, placement, style, setter);
    });
}

PlanePlace place_of(const MapScene& scene, const MapStyle& style, int width_px, int height_px) {
    return plane_place(frame_of(scene, style, width_px, height_px));
}

GeoBox ground_shown(const MapScene& scene, const MapStyle& style, int width_px, int height_px) {
    const auto frame = frame_of(scene, style, width_px, height_px);
    const auto north_west = to_geo(frame, {0, 0});
    const auto south_east = to_geo(frame, {double(width_px), double(height_px)});
    return {.west_deg = north_west.lon_deg,
            .south_deg = south_east.lat_deg,
            .east_deg = south_east.lon_deg,
            .north_deg = north_west.lat_deg};
}

double ground_width_m(const MapScene& scene, const MapStyle& style, int width_px, int height_px) {
    return width_px * metres_per_px(frame_of(scene, style, width_px, height_px), height_px / 2.0);
}

} // namespace macadam
