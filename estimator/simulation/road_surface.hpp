#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Limits of the ratios of a RoadRecipe, within which its filter can bend.
inline constexpr double min_wave_ratio = 0.2;
inline constexpr double max_wave_ratio = 8;

/// Parameters of a simulated road. A recipe and a seed always give the same surface.
struct RoadRecipe {
    double iri_mm_per_m = 2; ///< target mean over a long road; the true value is measured
    double waviness = 2;     ///< ISO 8608: G(n) = G(n0) (n / n0)^-waviness

    /// Mean spectral density of slope over waves of 15 to 30 m, and over waves of 1 to 2 m,
    /// relative to that over waves of 4 to 8 m. `std::nullopt`: as the waviness gives.
    std::optional<double> long_wave_ratio = std::nullopt;
    std::optional<double> short_wave_ratio = std::nullopt;

    double level_sd = 0.25;        ///< of the natural logarithm of roughness along the road, ...
    double level_length_m = 150;   ///< ... which changes over this distance
    double coherency_length_m = 3; ///< the two tracks agree in waves longer than a few of these
    double joint_spacing_m = 0;    ///< length of slabs; 0: none
    double joint_step_mm = 3;      ///< faulting and dip at a joint, standard deviation
    double patches_per_km = 0;     ///< 1 to 15 m long, with an edge at both ends, one track or both
    double potholes_per_km = 0;    ///< 0.3 to 1 m long, 10 to 60 mm deep, in one track
};

/// Surface of one lane from its beginning to its end, in driving direction: elevation at even
/// stations along it and on a few lines across it. It begins and ends at elevation 0 with zero
/// slope over some metres, so that lanes can follow each other without a step.
struct RoadSurface {
    double step_m = 0.05;              ///< nominal; adjusted to a whole number of steps per length
    std::vector<float> line_lateral_m; ///< increasing, from the lane's middle, left positive
    std::vector<std::vector<float>> elevation_m; ///< per line, same number of stations each

    double length_m() const;
};

/// Generates a surface from white noise through first-order filters. Their gain is computed so that
/// the expected IRI of a wheel path is the recipe's, including joints, patches and potholes (as far
/// as these leave a third of it to the noise). The noise consists of a part common to the lane and
/// an independent part: the coherency between the wheel paths is 1 / (1 + (n *
/// coherency_length)^2); the independent waves vary over 0.4 m across. It takes about 5 ms and 0.9
/// MB per kilometre.
///
/// \param length_m    0.1 to 200,000
/// \throws InputError  if the length or a parameter of the recipe is out of its range.
///
/// Source: ISO 8608:2016 (spectrum); C. J. Dodds, J. D. Robson, "The description of road surface
/// roughness", Journal of Sound and Vibration 31 (1973), pp. 175-183 (two tracks).
RoadSurface make_surface(const RoadRecipe& recipe, double length_m, std::uint64_t seed);

/// Interpolates the elevation at a station and a lateral position of the lane: linearly between
/// stations, and across by a cubic, so that a path between two lines is as rough as they are.
/// Positions are clamped to the borders.
double elevation_m(const RoadSurface& surface, double station_m, double lateral_m);

/// Lateral position of the wheel paths that a profiler measures, from the lane's middle (ASTM E950
/// leaves 1.4 to 1.8 m between them).
inline constexpr double wheel_path_m = 0.75;

/// True elevation of the two wheel paths, at every station of the surface.
struct WheelPaths {
    double step_m;
    std::vector<double> left_m;
    std::vector<double> right_m;
};
WheelPaths wheel_paths(const RoadSurface& surface);

/// Road under a car's wheels along its travel, lane after lane.
struct RoadUnderWheels {
    double step_m = 0.05;
    std::vector<float> left_m;
    std::vector<float> right_m;
};

} // namespace macadam
