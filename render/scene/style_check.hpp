#pragma once

#include "render/scene/scene.hpp"

#include <string>
#include <vector>

namespace macadam {

inline constexpr double min_class_difference = 10; ///< CIEDE2000, under every kind of sight
inline constexpr double min_casing_contrast = 3;   ///< to the ground, as WCAG 2.1 asks of symbols

/// What a reader of such a map could take for something else, a sentence each; empty for the
/// shipped looks: the two classes that some reader can hardly tell apart, or a casing that does not
/// stand out from the ground.
///
/// \throws InputError  for an unknown ramp.
std::vector<std::string> style_warnings(const MapStyle& style, const ClassTable& classes);

} // namespace macadam
