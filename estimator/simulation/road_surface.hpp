#pragma once

#include <cstdint>
#include <vector>

namespace macadam {

/// What a simulated road is like. A recipe and a seed give one surface, always the same.
struct RoadRecipe {
    double iri_mm_per_m = 2;       ///< aim of the mean over a long road; the truth is measured
    double waviness = 2;           ///< ISO 8608: G(n) = G(n0) (n / n0)^-waviness
    double level_sd = 0.25;        ///< of the natural logarithm of roughness along the road, ...
    double level_length_m = 150;   ///< ... which changes over this distance
    double coherency_length_m = 3; ///< the two tracks are alike in waves longer than a few of these
    double joint_spacing_m = 0;    ///< of slabs; 0: none
    double joint_step_mm = 3;      ///< faulting and dip at a joint, standard deviation
    double patches_per_km = 0;     ///< 1 to 15 m long, with an edge at both ends, one track or both
    double potholes_per_km = 0;    ///< 0.3 to 1 m long, 10 to 60 mm deep, in one track
};

/// One lane from its beginning to its end, in driving direction, as a sheet: elevation on even
/// stations along it and on a few lines across it. It begins and ends at elevation 0 with no
/// slope over metres, so that lanes can follow each other without a step.
struct RoadSurface {
    double step_m = 0.05;                        ///< near that: a whole number makes the length
    std::vector<float> line_lateral_m;           ///< rising, from the lane's middle, left positive
    std::vector<std::vector<float>> elevation_m; ///< per line, as many stations each

    double length_m() const;
};

/// White noise through first-order filters, whose gain is computed so that the expected IRI of a
/// wheel path is the recipe's, joints, patches and potholes included (as far as they leave room for
/// a third of it). What is common to the lane and what is not split its power:
/// coherency 1 / (1 + (n * coherency_length)^2) between the wheel paths; waves that are not common
/// change over 0.4 m across. About 5 ms a kilometre, 0.9 MB.
///
/// \param length_m    0.1 to 200,000
/// \throws InputError if the length or a number of the recipe is out of its range.
///
/// Source: ISO 8608:2016 (spectrum); C. J. Dodds, J. D. Robson, "The description of road surface
/// roughness", Journal of Sound and Vibration 31 (1973), pp. 175-183 (two tracks).
RoadSurface make_surface(const RoadRecipe& recipe, double length_m, std::uint64_t seed);

/// Elevation at a station and a lateral place of the lane: between stations by a line, across by a
/// cubic, so that a path between two lines is as rough as they are. Held at the borders.
double elevation_m(const RoadSurface& surface, double station_m, double lateral_m);

/// Where a profiler measures: the wheel paths, from the lane's middle (ASTM E950 leaves 1.4 to 1.8
/// m between them).
inline constexpr double wheel_path_m = 0.75;

/// Elevation of the two wheel paths, at every station of the surface: the truth.
struct WheelPaths {
    double step_m;
    std::vector<double> left_m;
    std::vector<double> right_m;
};
WheelPaths wheel_paths(const RoadSurface& surface);

/// The road under a car's wheels along its travel, lane after lane.
struct RoadUnderWheels {
    double step_m = 0.05;
    std::vector<float> left_m;
    std::vector<float> right_m;
};

} // namespace macadam
