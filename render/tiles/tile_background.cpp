#include "render/tiles/tile_background.hpp"

#include "render/background/background_painter.hpp"
#include "render/background/background_shapes.hpp"
#include "render/projection/projection.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace macadam {
namespace {

/// Look of the names of a rank of places.
struct PlaceLook {
    double size_px;
    bool bold;
    int from_zoom; ///< of tiles of 256 px
};
constexpr std::array<PlaceLook, place_ranks> place_looks{PlaceLook{18, true, 6},
                                                         PlaceLook{16, true, 9},
                                                         PlaceLook{14, false, 12},
                                                         PlaceLook{12, false, 13}};

/// Scale 1:N of a zoom at the equator, the same at every latitude: levels and widths must not
/// change from tile to tile.
///
/// Source: OGC 17-083r2, annex D.1, WebMercatorQuad.
double denominator_of(const WorldScale& scale) {
    constexpr double of_zoom_0 = 559082264.0287178;
    return of_zoom_0 / std::exp2(zoom_of_256_px(scale));
}

/// Rounds heights to those that a CoverageMask counts exactly. Shapes to the left of a tile, which
/// other tiles have and this one has not, then leave no rounding error on it.
void lay_on_rows(std::vector<BackgroundShape>& shapes) {
    constexpr double per_px = 65536;
    for (auto& shape : shapes) {
        for (auto& ring : shape.rings) {
            for (auto& point : ring) {
                point.y = std::round(point.y * per_px) / per_px;
            }
        }
    }
}

} // namespace

const BackgroundLevel& tile_background_level(const WorldScale& scale) {
    return background_level(denominator_of(scale));
}

PaintPart tile_ground(std::span<const BackgroundTile> tiles,
                      const WorldWindow& window,
                      MapStyle::Theme theme,
                      std::uint32_t ground_rgb) {
    const auto left_px = static_cast<double>(window.left_px);
    const auto top_px = static_cast<double>(window.top_px);
    const auto frame = world_frame(window.scale);
    const double side_px = window.side_px;
    const auto middle = to_geo(frame, {left_px + side_px / 2, top_px + side_px / 2});
    auto shapes = background_shapes(tiles,
                                    frame,
                                    {left_px - background_reach_px,
                                     top_px - background_reach_px,
                                     left_px + side_px + background_reach_px,
                                     top_px + side_px + background_reach_px},
                                    {.unit = 1, .denominator = denominator_of(window.scale)},
                                    middle.lon_deg);
    lay_on_rows(shapes);
    return painted_background(std::move(shapes), theme, ground_rgb);
}

std::vector<PointName> tile_places(std::span<const PlaceName> places, const WorldScale& scale) {
    const auto frame = world_frame(scale);
    std::vector<PointName> names;
    for (const auto& place : places) {
        const auto& [size_px, bold, from_zoom] = place_looks[static_cast<std::size_t>(place.rank)];
        if (zoom_of_256_px(scale) >= from_zoom) {
            const auto at = to_pixel(frame, place.position);
            names.push_back({.at = {std::round(at.x), std::round(at.y)},
                             .name = place.name,
                             .look = {size_px, bold}});
        }
    }
    return names;
}

} // namespace macadam
