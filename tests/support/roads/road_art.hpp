#pragma once

#include "estimator/motion/odometer.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {

/// A road network drawn in letters, and where the letters are.
struct RoadArt {
    std::vector<Way> ways;
    RoadNetwork roads;
    std::map<char, GeoPoint> places;
};

/// Each letter is a point, `cell_m` apart per column and 2 * cell_m per row, north upwards, near
/// Lyon. Each road is a word of letters and becomes a way, numbered from 1; a word that ends in '>'
/// is oneway, one in '<' oneway against its letters. The identity of a point is its letter's code.
///
///     const auto art = road_art(R"(
///         A----B----C
///              |
///              D
///     )", 10, {"ABC", "BD>"});
///
/// Letters must be unique.
RoadArt road_art(std::string_view art, double cell_m, const std::vector<std::string>& roads);

/// The edge whose way goes on from the point `from` to the point `to`.
EdgeId edge_between(const RoadArt& art, char from, char to);

/// A line through letters; each may be followed by a fraction of the way to the next in tenths, as
/// in "A5BC": it begins half-way between A and B. The last may be preceded by one: "AB5C" ends
/// half-way between B and C.
std::vector<GeoPoint> line_through(const RoadArt& art, std::string_view letters);

struct DriveConfig {
    double speed_mps = 14;
    double fix_step_s = 1;
    double noise_m = 0; ///< white, per axis
    std::uint64_t seed = 1;
    bool speeds = false;  ///< wheel speed at 10 Hz
    bool courses = false; ///< course and speed of the receiver
};

/// The trip of a car at constant speed along a line. The stamp of fix k is k * fix_step_s.
TripLog drive(const std::vector<GeoPoint>& line, const DriveConfig& config = {});

} // namespace macadam::testing
