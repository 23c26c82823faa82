#pragma once

#include <numbers>

namespace macadam {

inline constexpr double rad_per_deg = std::numbers::pi / 180;
inline constexpr double deg_per_rad = 180 / std::numbers::pi;

} // namespace macadam
