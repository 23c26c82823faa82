#include "render/road_painter.hpp"

#include "render/ribbon_painter.hpp"
#include "render/road_strands.hpp"

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

constexpr int lowest_rank = 5;
constexpr double unmeasured_core = 0.75; // of a measured one: quieter

using Strands = std::vector<const Strand*>;

bool is_measured(const Strand& strand) {
    return strand.looks.front() != unmeasured_look;
}

/// All classes, and what is drawn as wide as they.
std::uint64_t looks_of(bool certain) {
    std::uint64_t looks = certain ? only(few_passes_look) : 0;
    for (int i = 0; i < most_classes; ++i) {
        looks |= only(look_of(i, certain));
    }
    return looks;
}

Strands strands_of(std::span<const Strand> strands, int rank, bool measured) {
    Strands found;
    for (const auto& strand : strands) {
        if (!strand.looks.empty() && std::clamp(strand.rank, 0, lowest_rank) == rank &&
            is_measured(strand) == measured) {
            found.push_back(&strand);
        }
    }
    return found;
}

void draw(RibbonPainter& painter,
          const Strands& strands,
          const RibbonPass& pass,
          std::uint32_t rgb) {
    // A few strands at a time, so that the quads of a large city need not be held at once.
    constexpr std::size_t enough = 65536;
    std::vector<RibbonQuad> quads;
    for (const auto* strand : strands) {
        const auto more = ribbon(*strand, pass);
        quads.insert(quads.end(), more.begin(), more.end());
        if (quads.size() >= enough) {
            painter.draw(quads, rgb, pass.radius_px);
            quads.clear();
        }
    }
    painter.draw(quads, rgb, pass.radius_px);
}

/// Four bytes a pixel to three, where they stand.
std::vector<std::uint8_t> without_alpha(std::vector<std::uint8_t> rgba) {
    const std::size_t pixels = rgba.size() / 4;
    for (std::size_t i = 1; i < pixels; ++i) {
        std::copy_n(rgba.begin() + std::ptrdiff_t(4 * i), 3, rgba.begin() + std::ptrdiff_t(3 * i));
    }
    rgba.resize(pixels * 3);
    return rgba;
}

} // namespace

Image painted_roads(const Sheet& sheet,
                    std::span<const Strand> strands,
                    const LineWidths& widths,
                    const Palette& palette,
                    std::span<const std::uint32_t> class_colours) {
    std::vector<std::uint8_t> rgba(std::size_t(sheet.width_px) * std::size_t(sheet.height_px) * 4);
    {
        const GlContext context{rgba, sheet.width_px, sheet.height_px};
        RibbonPainter painter{context, sheet.width_px, sheet.height_px};
        painter.clear({0, 0, double(sheet.width_px), double(sheet.height_px)}, palette.page);
        painter.clear(sheet.map, palette.ground);

        for (int rank = lowest_rank; rank >= 0; --rank) {
            const double radius_px = core_radius_px(widths, rank, true) * unmeasured_core;
            draw(painter,
                 strands_of(strands, rank, false),
                 {radius_px, every_look, sheet.map},
                 palette.unmeasured);
        }
        for (int rank = lowest_rank; rank >= 0; --rank) {
            const auto measured = strands_of(strands, rank, true);
            for (const bool certain : {false, true}) {
                draw(painter,
                     measured,
                     {casing_radius_px(widths, rank, certain), looks_of(certain), sheet.map},
                     palette.casing);
            }
            draw(painter,
                 measured,
                 {core_radius_px(widths, rank, true), only(few_passes_look), sheet.map},
                 palette.few_passes);
            for (std::size_t i = 0; i < class_colours.size(); ++i) {
                for (const bool certain : {false, true}) {
                    draw(painter,
                         measured,
                         {core_radius_px(widths, rank, certain),
                          only(look_of(int(i), certain)),
                          sheet.map},
                         class_colours[i]);
                }
            }
        }
        painter.finish();
    }
    return {sheet.width_px, sheet.height_px, without_alpha(std::move(rgba))};
}

} // namespace macadam
