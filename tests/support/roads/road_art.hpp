#pragma once

#include "estimator/motion/odometer.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {

/// Road network drawn in letters, with the positions of the letters.
struct RoadArt {
    std::vector<Way> ways;
    RoadNetwork roads;
    std::map<char, GeoPoint> places;
};

/// Builds a network from a drawing. Each letter is a point, `cell_m` apart per column and 2 *
/// cell_m per row, north upwards, near Lyon. Each road is a word of letters and becomes a way,
/// numbered from 1. A word that ends in '>' is oneway; a word that ends in '<' is oneway against
/// its letters. The id of a point is its letter's code.
///
///     const auto art = road_art(R"(
///         A----B----C
///              |
///              D
///     )", 10, {"ABC", "BD>"});
///
/// Letters must be unique.
RoadArt road_art(std::string_view art, double cell_m, const std::vector<std::string>& roads);

/// Returns the edge whose way leads from the point `from` to the point `to`.
EdgeId edge_between(const RoadArt& art, char from, char to);

/// Returns a line through letters. A digit after a letter is a fraction of the way to the next, in
/// tenths: "A5BC" begins half-way between A and B. A digit before the last letter ends the line
/// early: "AB5C" ends half-way between B and C.
std::vector<GeoPoint> line_through(const RoadArt& art, std::string_view letters);

struct DriveConfig {
    double speed_mps = 14;
    double fix_step_s = 1;
    double noise_m = 0; ///< white, per axis
    std::uint64_t seed = 1;
    bool speeds = false;  ///< wheel speed at 10 Hz
    bool courses = false; ///< course and speed of the receiver
};

/// Drives a line at constant speed. The time stamp of fix k is k * fix_step_s.
TripLog drive(const std::vector<GeoPoint>& line, const DriveConfig& config = {});

} // namespace macadam::testing
