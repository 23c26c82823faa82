#pragma once

#include "render/map/sheet/layout.hpp"
#include "render/map/sheet/legend.hpp"

#include <optional>

namespace macadam {

/// Placement of the data and the legend on the map.
struct Placement {
    MapFrame frame;
    LegendCard card{};
    PixelPoint corner{};           ///< of the card, top left
    bool makes_map_smaller = true; ///< or moves it: no ground without roads is as large as the card
    bool hides_roads = false;      ///< the card lies on some
};

/// Division of a sheet into the map and a band of page with the legend.
struct LegendBand {
    PixelBox map;
    LegendCard card;
    PixelPoint corner; ///< of the card, top left
};

/// Returns the denominator of a frame's scale on paper at half the map's height.
double scale_denominator_of(const MapFrame& frame, const Layout& layout);

/// Returns the frame that shows the scene's box in an area of the sheet: at the scene's own scale,
/// else as large as fits; on paper at a scale of two figures, such as 1:26,000.
MapFrame map_frame(const MapScene& scene, const Layout& layout, const PixelBox& room);

/// Places the legend on ground without roads: in a corner, else at an edge, with as many entries
/// side by side as that takes. If there is none, the data makes room for it, at the side or below,
/// whichever leaves the larger map. Small pictures, in which letters take more room, get a shorter
/// legend if the full one would reduce the map's scale by a tenth or more.
Placement
placement_of(const MapScene& scene, const Legend& legend, const Layout& layout, TypeSetter& setter);

/// Gives the legend a band of the sheet that would be empty ground because the data has another
/// shape: beside the map or below it. `std::nullopt` if the legend does not fit there without
/// reducing the map's scale, or if roads or a base map fill the ground around the data.
///
/// \param layout  whose map is the whole area between header and footer
std::optional<LegendBand>
legend_band(const MapScene& scene, const Legend& legend, const Layout& layout, TypeSetter& setter);

/// Gives the legend a strip at the map's foot, as low as its entries allow.
LegendBand legend_strip(const Legend& legend, const Layout& layout, TypeSetter& setter);

/// Returns the share of a sheet that neither its texts nor the data, within the scene's box, nor
/// the legend take.
double empty_share(const MapScene& scene, const Layout& layout, const Placement& placement);

} // namespace macadam
