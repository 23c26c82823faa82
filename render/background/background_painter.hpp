#pragma once

#include "mapping/style/base_map.hpp"
#include "render/background/background_fade.hpp"
#include "render/background/background_shapes.hpp"
#include "render/scene/colour.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Returns the colour of a kind in a theme; `std::nullopt` if the theme does not show it.
std::uint32_t background_colour(BackgroundKind kind, MapStyle::Theme theme);

/// Paints shapes on the ground colour, opaque.
///
/// \param shapes  sorted by kind
/// \param fade    to the ground, if any
PaintPart painted_background(std::vector<BackgroundShape> shapes,
                             MapStyle::Theme theme,
                             std::uint32_t ground_rgb,
                             std::optional<BackgroundFade> fade = {});

} // namespace macadam
