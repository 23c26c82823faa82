#pragma once

#include "mapping/style/base_map.hpp"
#include "render/background/background_shapes.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace macadam {

/// Transition of a background to the ground beyond the roads, where it ends within the map: an
/// extract's sea or woods reach beyond its roads by chance, up to a straight cut.
struct BackgroundFade {
    /// From the last position that shows all to the first that shows the ground; both infinite on
    /// sides where nothing fades.
    using Side = std::pair<double, double>;
    Side left, top, right, bottom;

    /// Returns the share of the background in what a position shows, 0 to 1.
    double share(double x, double y) const;
};

/// Returns the fade of a map within which the background ends; then also of the sides on which it
/// reaches the edge, if they have room. `std::nullopt` if it ends nowhere.
///
/// \param roads  box of the network on the picture
/// \param map    of the picture
/// \param width_px  maximum width of the transition
std::optional<BackgroundFade> background_fade(std::span<const BackgroundShape> shapes,
                                              const PixelBox& roads,
                                              const PixelBox& map,
                                              double width_px);

/// Blends the pixels of a part with the ground.
void fade(const BackgroundFade& by,
          const PicturePart& part,
          std::uint32_t ground_rgb,
          std::span<std::uint8_t> rgba);

} // namespace macadam
