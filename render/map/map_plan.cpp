#include "render/map/map_plan.hpp"

#include "estimator/common/error.hpp"
#include "mapping/geometry/antimeridian.hpp"
#include "render/background/background_painter.hpp"
#include "render/background/background_shapes.hpp"
#include "render/labels/label_painter.hpp"
#include "render/map/base_map_blend.hpp"
#include "render/map/map_labels.hpp"
#include "render/map/pdf_ground.hpp"
#include "render/map/pdf_labels.hpp"
#include "render/map/sheet/event_symbols.hpp"
#include "render/map/sheet/legend.hpp"
#include "render/map/sheet/legend_placement.hpp"
#include "render/map/shown_roads.hpp"
#include "render/roads/map_generalisation.hpp"
#include "render/roads/road_painter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace macadam {
namespace {

const PictureSize& checked(const PictureSize& size) {
    for (const int side_px : {size.width_px, size.height_px}) {
        if (side_px < min_image_px || side_px > max_image_px) {
            throw InputError{fmt::format("picture size '{}x{}', expected sides of {} to {} px",
                                         size.width_px,
                                         size.height_px,
                                         min_image_px,
                                         max_image_px)};
        }
    }
    return size;
}

constexpr double much_empty = 0.25; // of the sheet: something shall fill it
double middle_px(const Layout& layout) {
    return (layout.map.top + layout.map.bottom) / 2;
}

LabelInks label_inks(const Palette& colours) {
    return {colours.ink, colours.quiet_ink, colours.ground};
}

std::vector<BackgroundShape> shown_background(std::span<const BackgroundTile> tiles,
                                              const GeoBox& box,
                                              const MapFrame& frame,
                                              const Layout& layout) {
    return background_shapes(tiles,
                             frame,
                             layout.map,
                             {layout.paper_unit, scale_denominator_of(frame, layout)},
                             (box.west_deg + box.east_deg) / 2);
}

/// Returns the base map resampled to a picture; empty if the scene has none.
PaintPart ground_of(const MapScene& scene,
                    const MapStyle& style,
                    const MapFrame& frame,
                    const PictureSize& size) {
    if (!scene.base) {
        return {};
    }
    const auto place = plane_position(frame);
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

int rows_of_band(const PictureSize& size) {
    constexpr int pixels = 8'388'608; // 25 MB, and 67 MB of OpenGL memory
    return size.band_px > 0 ? size.band_px : std::max(1, pixels / size.width_px);
}

} // namespace

MapPlan::MapPlan(MapScene scene, MapStyle style, const PictureSize& size)
    : scene_{std::move(scene)}, style_{std::move(style)}, size_{checked(size)},
      layout_{layout_of(scene_, size_, setter_)} {
    plan_insets();
    set_roads(std::move(scene_.lines), std::move(scene_.events));
}

PictureSize MapPlan::inset_size(const PixelBox& box) const {
    return {.width_px = int(box.width()),
            .height_px = int(box.height()),
            .px_per_inch = size_.px_per_inch,
            .is_on_paper = size_.is_on_paper};
}

void MapPlan::plan_details() {
    const auto parts = detail_layout(scene_, style_, layout_, scene_.insets.size(), setter_);
    if (!parts) {
        scene_.insets.clear();
        return;
    }
    layout_.whole_map = parts->map;
    legend_room_ = parts->legend;
    inset_boxes_ = parts->boxes;
    auto style = style_;
    style.legend = false;
    for (std::size_t i = 0; i < scene_.insets.size(); ++i) {
        insets_.emplace_back(detail_scene(scene_, i), style, inset_size(inset_boxes_[i]));
    }
}

std::optional<DetailRoom> MapPlan::detail_room() {
    if (!scene_.insets.empty() || scene_.to_the_edge || scene_.scale_denominator > 0 ||
        empty_share() < much_empty) {
        return {};
    }
    const auto parts = detail_layout(scene_, style_, layout_, 0, setter_);
    if (!parts) {
        return {};
    }
    const auto frame = map_frame(scene_, layout_, inset(parts->map, map_margin_px * layout_.unit));
    const double map_scale = scale_denominator_of(frame, layout_);
    const auto scale = detail_scale(map_scale);
    if (!scale) {
        return {};
    }
    const double m_per_px = metres_per_px(frame, middle_px(layout_)) * *scale / map_scale;
    auto scene = scene_;
    scene.insets.emplace_back();
    const auto sheet = layout_of(detail_scene(scene, 0), inset_size(parts->boxes.front()), setter_);
    return DetailRoom{.count = parts->boxes.size(),
                      .scale_denominator = *scale,
                      .width_m = sheet.map.width() * m_per_px,
                      .height_m = sheet.map.height() * m_per_px};
}

void MapPlan::plan_insets() {
    if (scene_.insets.empty()) {
        return;
    }
    if (has_details(scene_)) {
        plan_details();
        return;
    }
    const auto locator = locator_scene(scene_);
    const auto divided = inset_layout(layout_, scene_.insets.size());
    if (!divided) { // too small: one map of all
        scene_.box = locator.box;
        scene_.insets.clear();
        return;
    }
    layout_.whole_map = divided->map;
    inset_boxes_ = divided->boxes;
    auto style = style_;
    style.legend = false;
    const auto add = [&](MapScene scene, const PixelBox& box) {
        insets_.emplace_back(std::move(scene), style, inset_size(box));
    };
    for (std::size_t i = 0; i < scene_.insets.size(); ++i) {
        add(inset_scene(scene_, scene_.insets[i]), inset_boxes_[i]);
    }
    add(locator, inset_boxes_.back());
}

void MapPlan::set_roads(std::vector<MapLine> lines, std::vector<MapEvent> events) {
    scene_.lines = std::move(lines);
    scene_.events = std::move(events);
    for (const auto& line : scene_.lines) {
        for (const auto& point : line.line) {
            network_ = including(network_, point);
        }
    }
    const double scale =
        scale_denominator_of(map_frame(scene_, layout_, layout_.whole_map), layout_);
    const auto shown = [&](const MapLine& line) { return is_shown(line, scale); };
    if (std::ranges::any_of(scene_.lines, shown)) { // else all, rather than an empty map
        std::erase_if(scene_.lines, std::not_fn(shown));
    }
    place_legend(legend_of(scene_, style_, classes_of(style_)));
}

void MapPlan::place_legend(const Legend& legend) {
    layout_.map = layout_.whole_map;
    placement_ = placement_of(scene_, legend_room_ ? Legend{} : legend, layout_, setter_);
    if (legend_room_) {
        for (const auto& form : forms_of(legend)) {
            placement_.card = widest_card(form, legend_room_->width(), layout_.unit, setter_);
            if (placement_.card.height_px <= legend_room_->height()) {
                break;
            }
        }
        placement_.card.framed = false;
        placement_.corner = {legend_room_->left, legend_room_->top};
        return;
    }
    const bool has_corner = !placement_.makes_map_smaller;
    if (legend.entries.empty() || (has_corner && empty_share() < much_empty)) {
        return;
    }
    auto band =
        background_.tiles.empty() ? legend_band(scene_, legend, layout_, setter_) : std::nullopt;
    if (!band && placement_.hides_roads) {
        band = legend_strip(legend, layout_, setter_);
    }
    const bool is_column = band && band->map.right < layout_.map.right;
    if (band && !(has_corner && is_column)) { // a column would be mostly empty page
        layout_.map = band->map;
        placement_ = placement_of(scene_, {}, layout_, setter_);
        placement_.card = band->card;
        placement_.corner = band->corner;
    }
}

const BackgroundLevel& MapPlan::background_level() const {
    return macadam::background_level(scale_denominator_of(placement_.frame, layout_));
}

void MapPlan::set_background(MapBackground background) {
    background_ = std::move(background);
    std::erase_if(scene_.places, [](const MapPlace& place) { return !place.is_marked; });
    for (const auto& place : background_.places) {
        scene_.places.push_back(
            {.name = place.name, .rank = int(place.rank), .at = place.position});
    }
}

GeoBox MapPlan::ground() const {
    constexpr double by_far = 1.5;      // of the box's diagonal
    constexpr double edge_share = 0.02; // of the picture's diagonal
    const auto grown_by = [](const GeoBox& box, double share) {
        return grown_over(
            box, share * distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg}));
    };
    if (scene_.projection) {
        return grown_by(scene_.box, by_far);
    }
    const auto north_west = to_geo(placement_.frame, {0, 0});
    const auto south_east =
        to_geo(placement_.frame, {double(size_.width_px), double(size_.height_px)});
    return grown_by({.west_deg = north_west.lon_deg,
                     .south_deg = south_east.lat_deg,
                     .east_deg = south_east.lon_deg,
                     .north_deg = north_west.lat_deg},
                    edge_share);
}

double MapPlan::scale() const {
    return scale_denominator_of(placement_.frame, layout_);
}

PlanePosition MapPlan::place() const {
    return plane_position(placement_.frame);
}

double MapPlan::ground_width_m() const {
    return size_.width_px * metres_per_px(placement_.frame, size_.height_px / 2.0);
}

std::optional<BackgroundFade> MapPlan::fade_of(std::span<const BackgroundShape> shapes) const {
    constexpr double width_px = 40;
    if (is_empty(network_)) {
        return {};
    }
    const auto& [west_deg, south_deg, east_deg, north_deg] = network_;
    const std::array corners{to_pixel(placement_.frame, {south_deg, west_deg}),
                             to_pixel(placement_.frame, {south_deg, east_deg}),
                             to_pixel(placement_.frame, {north_deg, west_deg}),
                             to_pixel(placement_.frame, {north_deg, east_deg})};
    const auto [left, right] = std::ranges::minmax(corners, {}, &PixelPoint::x);
    const auto [top, bottom] = std::ranges::minmax(corners, {}, &PixelPoint::y);
    return background_fade(
        shapes, {left.x, top.y, right.x, bottom.y}, layout_.map, width_px * layout_.paper_unit);
}

void MapPlan::draw_sheet(DrawTarget& target) {
    const auto colours = palette(style_);
    draw_events(target, scene_.events, placement_.frame, layout_.map, layout_.paper_unit, colours);
    draw_map_surround(target, layout_, placement_, style_, setter_);
    if (!insets_.empty()) {
        draw_inset_panel(target, layout_, inset_boxes_, colours);
    }
    if (has_details(scene_)) {
        draw_detail_marks(target, scene_, placement_.frame, layout_, colours, setter_);
    } else if (!insets_.empty()) {
        draw_locator(target,
                     scene_,
                     inset_boxes_.back(),
                     insets_.back().placement_.frame,
                     layout_.unit,
                     colours);
    }
}

void MapPlan::draw(const TakeRows& take, const Progress& progress) {
    const auto colours = palette(style_);
    std::vector<Image> insets;
    for (auto& inset : insets_) {
        insets.push_back(image_of(inset));
    }
    const auto roads = shown_roads(scene_, style_, placement_.frame, layout_);
    RoadPainter painter{colours, class_colours(style_, classes_of(style_).classes.size())};
    auto ground = ground_of(scene_, style_, placement_.frame, size_);
    if (!ground && !background_.tiles.empty()) {
        auto shapes = shown_background(background_.tiles, scene_.box, placement_.frame, layout_);
        const auto fade = fade_of(shapes);
        ground = painted_background(std::move(shapes), style_.theme, colours.ground, fade);
    }
    painter.begin({.width_px = size_.width_px,
                   .height_px = size_.height_px,
                   .map = layout_.map,
                   .ground = std::move(ground)},
                  roads.strands,
                  roads.widths);
    const auto labels =
        map_labels(scene_, style_, layout_, placement_, roads.widths, scale(), setter_);
    const int band_px = rows_of_band(size_);
    for (int top_px = 0; top_px < size_.height_px; top_px += band_px) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the picture was complete"};
        }
        const int count = std::min(band_px, size_.height_px - top_px);
        Canvas canvas{painter.rows(top_px, count), top_px};
        for (const auto& label : labels) {
            if (label.box.bottom >= top_px && label.box.top <= top_px + count) {
                draw_labels(canvas, {&label, 1}, {}, label_inks(colours), setter_);
            }
        }
        for (std::size_t i = 0; i < insets.size(); ++i) {
            canvas.lay(insets[i], int(inset_boxes_[i].left), int(inset_boxes_[i].top));
        }
        draw_sheet(canvas);
        take(std::move(canvas).finished().rgb);
        progress(std::size_t(top_px + count), std::size_t(size_.height_px));
    }
}

void MapPlan::draw_on(PdfPage& page) {
    const auto theme = palette(style_);
    const auto colours = class_colours(style_, classes_of(style_).classes.size());
    const auto roads = shown_roads(scene_, style_, placement_.frame, layout_);
    const auto labels =
        map_labels(scene_, style_, layout_, placement_, roads.widths, scale(), setter_);
    const auto base = ground_of(scene_, style_, placement_.frame, size_);
    page.fill({{0, 0, double(size_.width_px), double(size_.height_px)}}, theme.page);
    page.fill({layout_.map}, theme.ground);
    page.begin_clip(layout_.map);
    if (base) {
        page.lay(part_of(layout_.map), base(part_of(layout_.map)));
    } else {
        const auto shapes =
            shown_background(background_.tiles, scene_.box, placement_.frame, layout_);
        draw_background(page, shapes, style_.theme);
        if (const auto fade = fade_of(shapes)) {
            draw_fade(page, *fade, layout_.map, theme.ground);
        }
    }
    if (base || !background_.tiles.empty()) {
        draw_unmeasured_edges(page, roads.strands, roads.widths, theme.ground);
    }
    draw_roads(page, roads.strands, roads.widths, theme, colours);
    page.end_clip();
    draw_labels(page, labels, label_inks(theme), setter_);
    for (std::size_t i = 0; i < insets_.size(); ++i) {
        page.begin_part(inset_boxes_[i]);
        insets_[i].draw_on(page);
        page.end_clip();
    }
    draw_sheet(page);
}

std::string MapPlan::pdf(const PdfSheet& sheet) {
    return pdf_file(sheet, [&](PdfPage& page) { draw_on(page); });
}

Image image_of(MapPlan& plan) {
    const auto width_px = plan.size().width_px;
    const auto height_px = plan.size().height_px;
    Image image{width_px, height_px, {}};
    image.rgb.reserve(std::size_t(width_px) * std::size_t(height_px) * 3);
    plan.draw([&](std::span<const std::uint8_t> rgb) {
        image.rgb.insert(image.rgb.end(), rgb.begin(), rgb.end());
    });
    return image;
}

Image render_map(const MapScene& scene, const MapStyle& style, const PictureSize& size) {
    MapPlan plan{scene, style, size};
    return image_of(plan);
}

} // namespace macadam
