#pragma once

#include "render/scene/scene.hpp"

#include <string>
#include <vector>

namespace macadam {

inline constexpr double min_class_difference = 10; ///< CIEDE2000, for every kind of colour vision
inline constexpr double min_casing_contrast = 3;   ///< to the ground, as for symbols in WCAG 2.1

/// Returns possible confusions for readers of such a map, one sentence each; empty for the built-in
/// looks. It reports the two classes that some readers can hardly distinguish, and a casing that
/// does not stand out from the ground.
///
/// \throws InputError  for an unknown ramp.
std::vector<std::string> style_warnings(const MapStyle& style, const ClassTable& classes);

} // namespace macadam
