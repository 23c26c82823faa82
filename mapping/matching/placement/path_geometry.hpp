#pragma once

#include "mapping/matching/placement/matched_path.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {

/// Which lane errors go together: cars keep to one side of a two-way road's line, but not of a
/// carriageway's.
enum class LaneKind : std::uint8_t { two_way = 0, oneway = 1 };

/// A path as a car can drive it, its corners rounded, and how long that is: a car goes several
/// metres less than the map's line round a sharp corner. Points at even steps of the map's line;
/// as many of each.
struct SmoothedPath {
    double step_m; ///< of the map's line, from the path's beginning
    std::vector<PointEn> at;
    std::vector<double> driven_m;    ///< length of the rounded line up to here, rising
    std::vector<double> heading_rad; ///< counter-clockwise from east, without jumps of a turn
    std::vector<double> heading_sum; ///< of heading_rad over driven_m
    std::vector<LaneKind> lane;
    std::vector<std::array<double, 2>> turned_rad; ///< to the left so far, by kind of lane
    std::vector<std::uint32_t> first_piece; ///< per step_m of driven length: the piece it begins in
};

/// \returns fewer than two points if the path has no length.
SmoothedPath driven_line(const RoadPath& path, const RoadNetwork& roads, CandidateIndex& plane);

/// A place of the rounded line; beyond its ends, straight on.
struct DrivenPlace {
    PointEn at;
    PointEn ahead; ///< of length 1
    LaneKind lane;
    std::array<double, 2> turned_rad;
};
DrivenPlace place_at(const SmoothedPath& line, double driven_m);

/// The place of the map's line; driven_m_at is the inverse.
double along_m_at(const SmoothedPath& line, double driven_m);

/// How long the rounded line is up to a place of the map's.
double driven_m_at(const SmoothedPath& line, double along_m);

/// Mean heading over `half_m` before and after a place.
double mean_heading_rad(const SmoothedPath& line, double driven_m, double half_m);

} // namespace macadam
