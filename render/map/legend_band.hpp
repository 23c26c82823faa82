#pragma once

#include "render/map/layout.hpp"
#include "render/map/legend.hpp"

#include <optional>

namespace macadam {

/// Division of a sheet into the map and a band of page with the legend.
struct LegendBand {
    PixelBox map;
    LegendCard card;
    PixelPoint corner; ///< of the card, top left
};

/// Gives the legend a band of the sheet that would be empty ground because the data has another
/// shape: beside the map or below it. `std::nullopt` if the legend does not fit there without
/// reducing the map's scale, or if roads or a base map fill the ground around the data.
///
/// \param layout  whose map is the whole area between header and footer
std::optional<LegendBand>
legend_band(const MapScene& scene, const Legend& legend, const Layout& layout, TypeSetter& setter);

/// Returns the legend with as many entries side by side as fit into a width.
LegendCard widest_card(const Legend& legend, double room_px, double unit, TypeSetter& setter);

inline constexpr double map_margin_px = 30;  ///< between the data and the map's edge, at 1000 px
inline constexpr double card_margin_px = 18; ///< between the legend and the map's edge, likewise

} // namespace macadam
