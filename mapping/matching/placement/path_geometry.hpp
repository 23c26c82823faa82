#pragma once

#include "mapping/matching/placement/matched_path.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {

/// Groups of common lane error: cars keep to one side of a two-way road's line, but not of a
/// carriageway's.
enum class LaneKind : std::uint8_t { two_way = 0, oneway = 1 };

/// A path as a car can drive it, with rounded corners, and its length: a car drives several metres
/// less than the map's line round a sharp corner. Sampled at equal steps of the map's line; all
/// vectors have the same size.
struct SmoothedPath {
    double step_m; ///< of the map's line, from the start of the path
    std::vector<PointEn> at;
    std::vector<double> driven_m;    ///< length of the rounded line up to here, increasing
    std::vector<double> heading_rad; ///< counter-clockwise from east, unwrapped
    std::vector<double> heading_sum; ///< integral of heading_rad over driven_m
    std::vector<LaneKind> lane;
    std::vector<std::array<double, 2>> turned_rad; ///< cumulative left turn, by kind of lane
    std::vector<std::uint32_t>
        first_piece; ///< per step_m of driven length: index of the line segment
};

/// Rounds the corners of a path. \returns fewer than two points if the path has no length.
SmoothedPath driven_line(const RoadPath& path, const RoadNetwork& roads, CandidateIndex& plane);

/// A position on the rounded line; extrapolated straight beyond its ends.
struct PathPose {
    PointEn at;
    PointEn ahead; ///< unit vector
    LaneKind lane;
    std::array<double, 2> turned_rad;
};
PathPose place_at(const SmoothedPath& line, double driven_m);

/// Converts a driven length to a position on the map's line; the inverse of driven_m_at.
double along_m_at(const SmoothedPath& line, double driven_m);

/// Returns the length of the rounded line up to a position on the map's line.
double driven_m_at(const SmoothedPath& line, double along_m);

/// Averages the heading over `half_m` before and after a position.
double mean_heading_rad(const SmoothedPath& line, double driven_m, double half_m);

} // namespace macadam
