#pragma once

#include "estimator/simulation/road_surface.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

// Shapes of local road defects, with height 1.

/// Returns the height of a faulted slab, raised at its beginning and level with the next slab at
/// its end; 0 <= t <= 1 along it.
double faulted_slab(double t);

/// Returns the height of a slab that is higher in its middle than at its joints.
double curled_slab(double t);

/// Returns the height of a patch from 0 to length_m, with edges of 0.1 m.
double patch(double at_m, double length_m);

/// Returns the depth of a pothole from 0 to length_m, deepest in its middle.
double pothole(double at_m, double length_m);

inline constexpr double patch_height_m = 0.005; ///< standard deviation; some are depressions
inline constexpr double min_patch_m = 1, max_patch_m = 15;
inline constexpr double patch_in_both_tracks = 0.5; ///< probability
inline constexpr double min_pothole_m = 0.3, max_pothole_m = 1;
inline constexpr double min_pothole_depth_m = 0.01, max_pothole_depth_m = 0.06;
inline constexpr double pothole_half_width_m = 0.3;
inline constexpr double pothole_off_path_m = 0.2; ///< largest offset of its middle from the path

/// Pothole of a surface.
struct Pothole {
    double from_m; ///< station of its beginning
    double length_m;
    double depth_m;   ///< in its middle
    double lateral_m; ///< of its middle, left of the middle of the lane

    /// Returns the part of its depth that a line along the lane meets, from 0 to 1.
    double part_at(double line_lateral_m) const;
};

/// Returns the potholes that with_features adds to a surface of this length, in no order.
std::vector<Pothole> potholes_on(double length_m, const RoadRecipe& recipe, std::uint64_t seed);

/// Adds the joints, patches and potholes of the recipe to the surface.
RoadSurface with_features(RoadSurface surface, const RoadRecipe& recipe, std::uint64_t seed);

} // namespace macadam
