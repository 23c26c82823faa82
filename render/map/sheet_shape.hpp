#pragma once

#include "render/scene/scene.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Returns sizes of about the same area, up to 2.4 times as wide as high and the reverse, the usual
/// shapes first.
std::vector<PictureSize> other_shapes(const PictureSize& size);

/// Returns the size for a scene without lines: `usual` if it leaves less than a quarter of the
/// sheet empty, else that which leaves the least empty. If this is a third or more, the sheet is
/// for MapPlan::detail_room, and its longer side at most one and a half times the shorter.
PictureSize size_for(const MapScene& scene,
                     const MapStyle& style,
                     const PictureSize& usual,
                     std::span<const PictureSize> others);

} // namespace macadam
