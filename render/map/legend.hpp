#pragma once

#include "render/canvas/draw_target.hpp"
#include "render/scene/colour.hpp"

#include <string>
#include <vector>

namespace macadam {

struct LegendEntry {
    enum class Swatch { certain, uncertain, unmeasured };
    Swatch swatch = Swatch::certain;
    std::uint32_t rgb = 0;
    std::string name;
    std::string range;
    std::string length;
};

struct Legend {
    std::string title;
    std::vector<LegendEntry> entries;
};

/// The classes with their values, then what else the scene's lines show. Nothing if the style wants
/// no legend.
Legend legend_of(const MapScene& scene, const MapStyle& style, const ClassTable& classes);

/// The legend in three forms, the fullest first: as it is, without lengths, and with the values of
/// classes for their names.
std::vector<Legend> forms_of(const Legend& legend);

/// The legend as a table on a card, `columns` entries beside each other.
struct LegendCard {
    Legend legend;
    int columns = 1;
    double unit = 1;
    double name_px = 0, range_px = 0, length_px = 0; ///< widths of the parts of an entry
    double width_px = 0, height_px = 0;
};

LegendCard legend_card(const Legend& legend, int columns, double unit, TypeSetter& setter);

/// \param corner  top left, whole pixels
void draw_legend(DrawTarget& canvas,
                 TypeSetter& setter,
                 const LegendCard& card,
                 const PixelPoint& corner,
                 const Palette& colours);

} // namespace macadam
