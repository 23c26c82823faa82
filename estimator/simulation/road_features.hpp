#pragma once

#include "estimator/simulation/road_surface.hpp"

#include <cstdint>

namespace macadam {

// The shapes of what makes a road rough in places, of height 1.

/// A slab that stands proud at its beginning and meets the next one level; 0 <= t <= 1 along it.
double faulted_slab(double t);

/// A slab that is higher in its middle than at its joints.
double curled_slab(double t);

/// A patch from 0 to length_m, with edges of 0.1 m.
double patch(double at_m, double length_m);

/// A pothole from 0 to length_m, deepest in its middle.
double pothole(double at_m, double length_m);

inline constexpr double patch_height_m = 0.005; ///< standard deviation; some lie deeper
inline constexpr double min_patch_m = 1, max_patch_m = 15;
inline constexpr double patch_in_both_tracks = 0.5; ///< probability
inline constexpr double min_pothole_m = 0.3, max_pothole_m = 1;
inline constexpr double min_pothole_depth_m = 0.01, max_pothole_depth_m = 0.06;
inline constexpr double pothole_half_width_m = 0.3;
inline constexpr double pothole_off_path_m = 0.2; ///< at most, its middle from the wheel path

/// The surface with the joints, patches and potholes of its recipe.
RoadSurface with_features(RoadSurface surface, const RoadRecipe& recipe, std::uint64_t seed);

} // namespace macadam
