#pragma once

#include "render/canvas/draw_target.hpp"
#include "render/map/sheet/layout.hpp"
#include "render/scene/colour.hpp"
#include "render/scene/scene.hpp"

#include <string>
#include <vector>

namespace macadam {

struct LegendEntry {
    enum class Swatch { certain, uncertain, unmeasured, event };
    Swatch swatch = Swatch::certain;
    std::uint32_t rgb = 0;
    std::string name;
    std::string range;
    std::string length;
    EventKind event = EventKind::pothole; ///< of Swatch::event
};

struct Legend {
    std::string title;
    std::vector<LegendEntry> entries;
    std::string note{}; ///< how to read the map
};

/// Returns the classes with their values, then the other kinds of lines in the scene. Empty if the
/// style has no legend.
Legend legend_of(const MapScene& scene, const MapStyle& style, const ClassTable& classes);

/// Returns the legend in three forms, the fullest first: complete, without lengths and note,
/// and with the values of classes instead of their names.
std::vector<Legend> forms_of(const Legend& legend);

/// Legend as a table on a card, with `columns` entries side by side.
struct LegendCard {
    Legend legend;
    int columns = 1;
    double unit = 1;
    double name_px = 0, range_px = 0, length_px = 0; ///< column widths within an entry
    double width_px = 0, height_px = 0;
    std::vector<std::string> note{}; ///< its lines
    bool framed = true;              ///< a card on the map; false: on the page
};

LegendCard legend_card(const Legend& legend, int columns, double unit, TypeSetter& setter);

/// \param corner  top left, whole pixels
void draw_legend(DrawTarget& canvas,
                 TypeSetter& setter,
                 const LegendCard& card,
                 const PixelPoint& corner,
                 const Palette& colours);

/// Returns the legend with as many entries side by side as fit into a width.
LegendCard widest_card(const Legend& legend, double room_px, double unit, TypeSetter& setter);

inline constexpr double map_margin_px = 30;  ///< between the data and the map's edge, at 1000 px
inline constexpr double card_margin_px = 18; ///< between the legend and the map's edge, likewise

} // namespace macadam
