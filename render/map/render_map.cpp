#include "render/scene/scene.hpp"

#include "estimator/common/error.hpp"
#include "render/labels/label_painter.hpp"
#include "render/map/base_map_blend.hpp"
#include "render/map/map_labels.hpp"
#include "render/map/map_surround.hpp"
#include "render/map/pdf_labels.hpp"
#include "render/map/pdf_map.hpp"
#include "render/map/pdf_roads.hpp"
#include "render/roads/line_joining.hpp"
#include "render/roads/road_painter.hpp"
#include "render/roads/road_polylines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

void check_size(int width_px, int height_px) {
    for (const int side_px : {width_px, height_px}) {
        if (side_px < min_image_px || side_px > max_image_px) {
            throw InputError{fmt::format("picture size '{}x{}', expected sides of {} to {} px",
                                         width_px,
                                         height_px,
                                         min_image_px,
                                         max_image_px)};
        }
    }
}

const ClassTable& classes_of(const MapStyle& style) {
    return style.classes != nullptr ? *style.classes : *class_table("fhwa");
}

void check_classes(const MapScene& scene, const ClassTable& table) {
    if (table.classes.empty() || table.classes.size() > max_classes) {
        throw InputError{fmt::format("table '{}' has {} classes, expected 1 to {}",
                                     table.name,
                                     table.classes.size(),
                                     max_classes)};
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

std::vector<Polyline>
strands_of(const MapScene& scene, const std::vector<LineUse>& uses, const MapFrame& frame) {
    std::vector<Polyline> strands;
    for (const auto& chain : joined(scene.lines, uses)) {
        auto strand = strand_of(scene.lines, chain, frame);
        if (!strand.looks.empty()) {
            strands.push_back(std::move(strand));
        }
    }
    return strands;
}

/// Returns the scene with its lines densified for the projection.
MapScene bent_scene(const MapScene& scene, const MapFrame& frame) {
    auto shown = scene;
    for (auto& line : shown.lines) {
        line.line = bent(frame, line.line);
    }
    return shown;
}

struct Roads {
    std::vector<Polyline> strands;
    LineWidths widths;
};

/// Offsets the two directions of roads to their sides.
std::vector<Polyline> side_by_side(const MapScene& scene,
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

LabelInks label_inks(const Palette& colours) {
    return {colours.ink, colours.quiet_ink, colours.ground};
}

MapFrame frame_of(const MapScene& scene, const MapStyle& style, int width_px, int height_px) {
    check_size(width_px, height_px);
    TypeSetter setter;
    const auto layout = layout_of(scene, width_px, height_px, setter);
    const auto legend = legend_of(scene, style, classes_of(style));
    return placement_of(scene, legend, layout, setter).frame;
}

/// Returns the base map resampled to a picture; empty if the scene has none.
PaintPart ground_of(const MapScene& scene,
                    const MapStyle& style,
                    const MapFrame& frame,
                    const PictureSize& size) {
    if (!scene.base) {
        return {};
    }
    const auto place = plane_place(frame);
    return ground_with(scene.base->laid_on({.wkt = scene.projection ? scene.projection->wkt : "",
                                            .left = place.left,
                                            .top = place.top,
                                            .per_px = place.per_px,
                                            .width_px = size.width_px,
                                            .height_px = size.height_px}),
                       {.ground = palette(style).ground, .opacity = style.base_opacity});
}

PicturePart part_of(const PixelBox& box) {
    return {int(box.left), int(box.top), int(box.width()), int(box.height())};
}

/// Elements of a picture, drawn for a range of rows.
class Picture {
public:
    Picture(const MapScene& scene, const MapStyle& style, const PictureSize& size)
        : style_{style}, classes_{classes_of(style)}, colours_{palette(style)},
          layout_{layout_of(scene, size.width_px, size.height_px, setter_)},
          placement_{placement_of(scene, legend_of(scene, style, classes_), layout_, setter_)},
          roads_{shown_roads(scene, style, placement_.frame, layout_)},
          painter_{{size.width_px,
                    size.height_px,
                    layout_.map,
                    ground_of(scene, style, placement_.frame, size)},
                   roads_.strands,
                   roads_.widths,
                   colours_,
                   class_colours(style, classes_.classes.size())} {
        if (style.labels) {
            labels_ = map_labels(scene, layout_, placement_, roads_.widths, setter_);
        }
    }

    Image rows(int top_px, int count) {
        Canvas canvas{painter_.rows(top_px, count), top_px};
        for (const auto& label : labels_) {
            if (label.box.bottom >= top_px && label.box.top <= top_px + count) {
                draw_labels(canvas, {&label, 1}, {}, label_inks(colours_), setter_);
            }
        }
        draw_map_surround(canvas, layout_, placement_, style_, setter_);
        return std::move(canvas).finished();
    }

private:
    const MapStyle& style_;
    const ClassTable& classes_;
    Palette colours_;
    TypeSetter setter_;
    Layout layout_;
    Placement placement_;
    Roads roads_;
    RoadPainter painter_;
    std::vector<Label> labels_;
};

int rows_of_band(const PictureSize& size) {
    constexpr int pixels = 8'388'608; // 25 MB, and 67 MB of OpenGL memory
    return size.band_px > 0 ? size.band_px : std::max(1, pixels / size.width_px);
}

} // namespace

void draw_map(const MapScene& scene,
              const MapStyle& style,
              const PictureSize& size,
              const TakeRows& take,
              const Progress& progress) {
    check_size(size.width_px, size.height_px);
    check_classes(scene, classes_of(style));
    Picture picture{scene, style, size};
    const int band_px = rows_of_band(size);
    for (int top_px = 0; top_px < size.height_px; top_px += band_px) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the picture was complete"};
        }
        const int count = std::min(band_px, size.height_px - top_px);
        take(picture.rows(top_px, count).rgb);
        progress(std::size_t(top_px + count), std::size_t(size.height_px));
    }
}

Image render_map(const MapScene& scene, const MapStyle& style, int width_px, int height_px) {
    check_size(width_px, height_px);
    Image image{width_px, height_px, {}};
    image.rgb.reserve(std::size_t(width_px) * std::size_t(height_px) * 3);
    draw_map(scene, style, {width_px, height_px}, [&](std::span<const std::uint8_t> rgb) {
        image.rgb.insert(image.rgb.end(), rgb.begin(), rgb.end());
    });
    return image;
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
    const auto labels = style.labels ? map_labels(scene, layout, placement, roads.widths, setter)
                                     : std::vector<Label>{};
    const auto ground = ground_of(scene, style, placement.frame, {width_px, height_px});
    return pdf_file(sheet, [&](PdfPage& page) {
        page.fill({{0, 0, sheet.width_px, sheet.height_px}}, theme.page);
        page.fill({layout.map}, theme.ground);
        page.begin_clip(layout.map);
        if (ground) {
            page.lay(part_of(layout.map), ground(part_of(layout.map)));
            draw_unmeasured_edges(page, roads.strands, roads.widths, theme.ground);
        }
        draw_roads(page, roads.strands, roads.widths, theme, colours);
        page.end_clip();
        draw_labels(page, labels, label_inks(theme), setter);
        draw_map_surround(page, layout, placement, style, setter);
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
