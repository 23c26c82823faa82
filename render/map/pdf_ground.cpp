#include "render/map/pdf_ground.hpp"

#include "render/background/background_painter.hpp"
#include "render/roads/road_polylines.hpp"
#include "render/roads/stroke_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace macadam {
namespace {

constexpr int lowest_rank = 5;

using PolylineRefs = std::vector<const Polyline*>;

bool is_measured(const Polyline& line) {
    return line.looks.front() != unmeasured_look;
}

PolylineRefs lines_of(std::span<const Polyline> lines, int rank, bool measured) {
    PolylineRefs found;
    for (const auto& line : lines) {
        if (!line.looks.empty() && std::clamp(line.rank, subject_rank, lowest_rank) == rank &&
            is_measured(line) == measured) {
            found.push_back(&line);
        }
    }
    return found;
}

struct PdfPen {
    double radius_px;
    std::uint64_t looks; ///< one bit per look
    std::uint32_t rgb;
};

bool is_of(const PdfPen& brush, const Polyline& line, std::size_t piece) {
    return (brush.looks >> line.looks[piece] & 1U) != 0;
}

/// Draws neighbouring line segments of the pen's looks as one line. Earlier lines have round ends
/// below later ones, which are cut off where the look changes: each look keeps its exact length,
/// and bends have no gaps.
void draw(PdfPage& page, const Polyline& line, const PdfPen& brush) {
    const auto& looks = line.looks;
    for (std::size_t i = 0; i < looks.size();) {
        std::size_t end = i;
        while (end < looks.size() && is_of(brush, line, end)) {
            ++end;
        }
        if (end > i) {
            page.draw(std::span{line.points}.subspan(i, end - i + 1),
                      brush.radius_px,
                      brush.rgb,
                      {.round_begin = i == 0 || looks[i - 1] > looks[i],
                       .round_end = end == looks.size() || looks[end] > looks[end - 1]});
        }
        i = std::max(end, i + 1);
    }
}

void draw(PdfPage& page, const PolylineRefs& lines, const PdfPen& brush) {
    for (const auto* line : lines) {
        draw(page, *line, brush);
    }
}

std::uint64_t bit_of(int look) {
    return std::uint64_t{1} << look;
}

std::uint64_t looks_of(std::size_t classes, bool certain) {
    std::uint64_t looks = certain ? bit_of(few_passes_look) : 0;
    for (std::size_t i = 0; i < classes; ++i) {
        looks |= bit_of(look_of(int(i), certain));
    }
    return looks;
}

} // namespace

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

void draw_fade(PdfPage& page,
               const BackgroundFade& fade,
               const PixelBox& map,
               std::uint32_t ground_rgb) {
    const auto& [left, top, right, bottom] = fade;
    const auto veil = [&](const PixelBox& box, const PixelPoint& from, const PixelPoint& to) {
        if (std::isfinite(from.x + from.y)) {
            page.veil(box, from, to, ground_rgb);
        }
    };
    veil({map.left, map.top, -left.first, map.bottom}, {-left.first, 0}, {-left.second, 0});
    veil({right.first, map.top, map.right, map.bottom}, {right.first, 0}, {right.second, 0});
    veil({map.left, map.top, map.right, -top.first}, {0, -top.first}, {0, -top.second});
    veil({map.left, bottom.first, map.right, map.bottom}, {0, bottom.first}, {0, bottom.second});
}

void draw_unmeasured_edges(PdfPage& page,
                           std::span<const Polyline> lines,
                           const LineWidths& widths,
                           std::uint32_t rgb) {
    for (int rank = lowest_rank; rank >= subject_rank; --rank) {
        draw(page,
             lines_of(lines, rank, false),
             {unmeasured_edge_radius_px(widths, rank), every_look, rgb});
    }
}

void draw_roads(PdfPage& page,
                std::span<const Polyline> lines,
                const LineWidths& widths,
                const Palette& palette,
                std::span<const std::uint32_t> class_colours) {
    for (int rank = lowest_rank; rank >= subject_rank; --rank) {
        draw(page,
             lines_of(lines, rank, false),
             {unmeasured_radius_px(widths, rank), every_look, palette.unmeasured});
    }
    for (int rank = lowest_rank; rank >= subject_rank; --rank) {
        const auto measured = lines_of(lines, rank, true);
        if (rank == subject_rank) {
            draw(page, measured, {subject_air_radius_px(widths), every_look, palette.ground});
            draw(page, measured, {subject_edge_radius_px(widths), every_look, palette.casing});
        }
        for (const bool certain : {false, true}) {
            draw(page,
                 measured,
                 {casing_radius_px(widths, rank, certain),
                  looks_of(class_colours.size(), certain),
                  palette.casing});
        }
        draw(page,
             measured,
             {core_radius_px(widths, rank, true), bit_of(few_passes_look), palette.few_passes});
        for (std::size_t i = 0; i < class_colours.size(); ++i) {
            for (const bool certain : {false, true}) {
                draw(page,
                     measured,
                     {core_radius_px(widths, rank, certain),
                      bit_of(look_of(int(i), certain)),
                      class_colours[i]});
            }
        }
    }
}

} // namespace macadam
