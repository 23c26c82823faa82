#include "render/roads/road_painter.hpp"

#include "render/gl/pixel_painter.hpp"
#include "render/roads/road_polylines.hpp"
#include "render/roads/stroke_painter.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <utility>

namespace macadam {
namespace {

constexpr int lowest_rank = 5;

bool is_measured(const Polyline& polyline) {
    return polyline.looks.front() != unmeasured_look;
}

/// Returns all classes, and the other looks of the same width.
std::uint64_t looks_of(bool certain) {
    std::uint64_t looks = certain ? only(few_passes_look) : 0;
    for (int i = 0; i < max_classes; ++i) {
        looks |= only(look_of(i, certain));
    }
    return looks;
}

/// Part of the sheet that OpenGL draws at once.
struct Window {
    double left_px, top_px; ///< on the polylines' plane
    int width_px, height_px;
};

PixelBox box_of(const Window& window) {
    return {window.left_px,
            window.top_px,
            window.left_px + window.width_px,
            window.top_px + window.height_px};
}

PixelBox common(const PixelBox& a, const PixelBox& b) {
    const double left = std::max(a.left, b.left);
    const double top = std::max(a.top, b.top);
    return {left,
            top,
            std::max(left, std::min(a.right, b.right)),
            std::max(top, std::min(a.bottom, b.bottom))};
}

PixelBox moved(const PixelBox& box, double right_px, double down_px) {
    return {box.left + right_px, box.top + down_px, box.right + right_px, box.bottom + down_px};
}

bool meet(const PixelBox& a, const PixelBox& b, double apart_px) {
    return a.left <= b.right + apart_px && b.left <= a.right + apart_px &&
           a.top <= b.bottom + apart_px && b.top <= a.bottom + apart_px;
}

PixelBox box_around(const Polyline& polyline) {
    PixelBox box{polyline.points.front().x,
                 polyline.points.front().y,
                 polyline.points.front().x,
                 polyline.points.front().y};
    for (const auto& point : polyline.points) {
        box = {std::min(box.left, point.x),
               std::min(box.top, point.y),
               std::max(box.right, point.x),
               std::max(box.bottom, point.y)};
    }
    return box;
}

struct Road {
    const Polyline* polyline;
    PixelBox box;
    std::uint64_t looks; ///< of its line segments
};

using Roads = std::vector<const Road*>;

std::uint64_t looks_of(const Polyline& polyline) {
    std::uint64_t looks = 0;
    for (auto i = polyline.first; i < std::min(polyline.past, polyline.looks.size()); ++i) {
        looks |= only(polyline.looks[i]);
    }
    return looks;
}

/// Roads painted together.
struct Layer {
    std::vector<Road> measured, unmeasured;
};

constexpr std::size_t layer_of(int rank) {
    return std::size_t(std::clamp(rank, subject_rank, lowest_rank) - subject_rank);
}

using Layers = std::array<Layer, layer_of(lowest_rank) + 1>;

Layers layers_of(std::span<const Polyline> polylines) {
    Layers layers;
    for (const auto& polyline : polylines) {
        if (!polyline.looks.empty()) {
            auto& layer = layers[layer_of(polyline.rank)];
            (is_measured(polyline) ? layer.measured : layer.unmeasured)
                .push_back({&polyline, box_around(polyline), looks_of(polyline)});
        }
    }
    return layers;
}

/// Margin beyond the line itself: half a pixel of antialiasing, the overlap of looks, and rounding.
constexpr double beyond_line_px = 4;

Roads near(const std::vector<Road>& roads, const PixelBox& box, double radius_px) {
    Roads found;
    for (const auto& road : roads) {
        if (meet(road.box, box, radius_px + beyond_line_px)) {
            found.push_back(&road);
        }
    }
    return found;
}

/// OpenGL painter with its memory.
struct GlRoadPainter {
    GlRoadPainter(int width, int height)
        : width_px{width}, height_px{height}, rgba(std::size_t(width) * std::size_t(height) * 4),
          context{rgba, width, height}, painter{context}, pixels{context} {}

    int width_px, height_px;
    std::vector<std::uint8_t> rgba;
    GlContext context;
    StrokePainter painter;
    PixelPainter pixels;
    std::vector<StrokeQuad> quads; ///< memory of draw()
};

/// Draws roads in batches, so that the quads of a large city need not be in memory at once.
void draw(GlRoadPainter& gl_painter,
          const Roads& roads,
          const StrokePass& pass,
          std::uint32_t rgb) {
    constexpr std::size_t enough = 16384;
    auto& quads = gl_painter.quads;
    const auto flush = [&] {
        gl_painter.painter.draw(quads, rgb, pass.radius_px);
        quads.clear();
    };
    for (const auto* road : roads) {
        if ((road->looks & pass.looks) == 0) {
            continue;
        }
        append_stroke(quads, *road->polyline, pass);
        if (quads.size() >= enough) {
            flush();
            gl_painter.painter.finish(); // or OpenGL keeps up to 70 MB of quads for later
        }
    }
    flush();
}

/// Copies four bytes per pixel to three, onto a band of the sheet.
void copy_pixels(
    const GlRoadPainter& gl_painter, const Window& window, int left, int down, Image& band) {
    for (int y = 0; y < window.height_px; ++y) {
        const auto* from =
            gl_painter.rgba.data() + std::size_t(y) * std::size_t(gl_painter.width_px) * 4;
        auto* to = band.rgb.data() +
                   (std::size_t(down + y) * std::size_t(band.width) + std::size_t(left)) * 3;
        for (int x = 1; x < window.width_px; ++x, from += 4, to += 3) {
            std::memcpy(to, from, 4); // faster than three; the next pixel overwrites the fourth
        }
        std::copy_n(from, 3, to);
    }
}

} // namespace

struct RoadPainter::Impl {
    void paint(const Window& window);
    void lay_ground(const Window& window, const PixelBox& map);
    void paint_unmeasured(int rank, const StrokePass& view, double radius_px, std::uint32_t rgb);
    void paint_measured(int rank, const StrokePass& view);
    void prepare(int width_px, int height_px);

    Palette palette;
    std::vector<std::uint32_t> class_colours;
    Sheet sheet{};
    Layers layers{};
    LineWidths widths{};
    std::unique_ptr<GlRoadPainter> gl_painter{};
};

/// Reuses the painter if it is large enough.
void RoadPainter::Impl::prepare(int width_px, int height_px) {
    if (gl_painter == nullptr || gl_painter->width_px < width_px ||
        gl_painter->height_px < height_px) {
        gl_painter.reset();
        gl_painter = std::make_unique<GlRoadPainter>(width_px, height_px);
    }
    gl_painter->context.make_current();
}

/// Copies the ground in bands, since their pixels are held three times.
void RoadPainter::Impl::lay_ground(const Window& window, const PixelBox& map) {
    constexpr int pixels = 2'097'152;
    const int left = int(map.left);
    const int width = int(map.width());
    const int bottom = int(map.bottom);
    const int rows = std::max(1, pixels / width);
    for (int top = int(map.top); top < bottom; top += rows) {
        const int height = std::min(rows, bottom - top);
        gl_painter->pixels.lay(
            {left - int(window.left_px), top - int(window.top_px), width, height},
            sheet.ground({left, top, width, height}));
    }
}

void RoadPainter::Impl::paint_unmeasured(int rank,
                                         const StrokePass& view,
                                         double radius_px,
                                         std::uint32_t rgb) {
    auto pass = view;
    pass.radius_px = radius_px;
    pass.looks = every_look;
    draw(*gl_painter, near(layers[layer_of(rank)].unmeasured, view.visible, radius_px), pass, rgb);
}

void RoadPainter::Impl::paint_measured(int rank, const StrokePass& view) {
    const bool is_subject = rank == subject_rank;
    const double widest_px = is_subject ? subject_air_radius_px(widths)
                                        : std::max(casing_radius_px(widths, rank, true),
                                                   casing_radius_px(widths, rank, false));
    const auto roads = near(layers[layer_of(rank)].measured, view.visible, widest_px);
    const auto paint = [&](double radius_px, std::uint64_t looks, std::uint32_t rgb) {
        auto pass = view;
        pass.radius_px = radius_px;
        pass.looks = looks;
        draw(*gl_painter, roads, pass, rgb);
    };
    if (is_subject) {
        paint(subject_air_radius_px(widths), every_look, palette.ground);
        paint(subject_edge_radius_px(widths), every_look, palette.casing);
    }
    for (const bool certain : {false, true}) {
        paint(casing_radius_px(widths, rank, certain), looks_of(certain), palette.casing);
    }
    paint(core_radius_px(widths, rank, true), only(few_passes_look), palette.few_passes);
    for (std::size_t i = 0; i < class_colours.size(); ++i) {
        for (const bool certain : {false, true}) {
            paint(core_radius_px(widths, rank, certain),
                  only(look_of(int(i), certain)),
                  class_colours[i]);
        }
    }
}

void RoadPainter::Impl::paint(const Window& window) {
    const auto whole = box_of(window);
    const auto map = common(whole, sheet.map);
    if (map != whole) {
        gl_painter->painter.clear(moved(whole, -whole.left, -whole.top), palette.page);
    }
    gl_painter->painter.clear(moved(map, -whole.left, -whole.top), palette.ground);
    const StrokePass view{.radius_px = 0,
                          .looks = 0,
                          .visible = map,
                          .left_px = window.left_px,
                          .top_px = window.top_px};
    if (map.width() > 0 && map.height() > 0) {
        if (sheet.ground) {
            lay_ground(window, map);
            for (int rank = lowest_rank; rank >= subject_rank; --rank) {
                paint_unmeasured(
                    rank, view, unmeasured_edge_radius_px(widths, rank), palette.ground);
            }
        }
        for (int rank = lowest_rank; rank >= subject_rank; --rank) {
            paint_unmeasured(rank, view, unmeasured_radius_px(widths, rank), palette.unmeasured);
        }
        for (int rank = lowest_rank; rank >= subject_rank; --rank) {
            paint_measured(rank, view);
        }
    }
    gl_painter->painter.finish();
}

RoadPainter::RoadPainter(const Palette& palette, std::span<const std::uint32_t> class_colours)
    : impl_{std::make_unique<Impl>(Impl{
          .palette = palette, .class_colours = {class_colours.begin(), class_colours.end()}})} {}

RoadPainter::~RoadPainter() = default;
RoadPainter::RoadPainter(RoadPainter&&) noexcept = default;
RoadPainter& RoadPainter::operator=(RoadPainter&&) noexcept = default;

void RoadPainter::begin(Sheet sheet,
                        std::span<const Polyline> polylines,
                        const LineWidths& widths) {
    impl_->sheet = std::move(sheet);
    impl_->layers = layers_of(polylines);
    impl_->widths = widths;
}

Image RoadPainter::rows(int top_px, int count) {
    assert(top_px >= 0 && count > 0 && top_px + count <= impl_->sheet.height_px);
    const auto& sheet = impl_->sheet;
    const int width_px = sheet.width_px;
    Image image{width_px, count, {}};
    image.rgb.resize(std::size_t(width_px) * std::size_t(count) * 3);
    const int window_width_px = std::min(width_px, max_stroke_window_px);
    const int window_height_px = std::min(count, max_stroke_window_px);
    impl_->prepare(window_width_px, window_height_px);
    for (int down = 0; down < count; down += window_height_px) {
        for (int left = 0; left < width_px; left += window_width_px) {
            const Window window{sheet.left_px + left,
                                sheet.top_px + top_px + down,
                                std::min(window_width_px, width_px - left),
                                std::min(window_height_px, count - down)};
            impl_->paint(window);
            copy_pixels(*impl_->gl_painter, window, left, down, image);
        }
    }
    return image;
}

Image painted_roads(const Sheet& sheet,
                    std::span<const Polyline> polylines,
                    const LineWidths& widths,
                    const Palette& palette,
                    std::span<const std::uint32_t> class_colours) {
    RoadPainter painter{palette, class_colours};
    painter.begin(sheet, polylines, widths);
    return painter.rows(0, sheet.height_px);
}

} // namespace macadam
