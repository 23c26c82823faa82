#pragma once

#include "render/scene/scene.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <string>

namespace macadam {

/// Returns the box that a map of data shows: with a margin, and ground beside a single road.
GeoBox box_with_margin(const GeoBox& box);

/// Returns the name of the most important place in a box, or "".
std::string place_in(const StoreReader& store, const GeoBox& box);

/// Gives up to three parts of the selected segments insets if they lie so far off the longest part
/// that this is shown at two and a half times the scale or more; the scene's box becomes that of
/// the longest part.
void set_insets(const StoreReader& store, const SegmentFilter& filter, MapScene& scene);

} // namespace macadam
