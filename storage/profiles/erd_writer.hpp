#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Elevations at even steps, as an ERD file holds them.
struct ErdProfile {
    std::string title;   ///< one line; empty: none
    double start_m = 0;  ///< station of the first point
    double step_m = 0.1; ///< > 0
    struct Channel {
        std::string name; ///< "left" and "right" become "LElev." and "RElev."; others are cut to 8
        std::vector<double> elevation_m; ///< finite
    };
    std::vector<Channel> channels;      ///< at least one, all of one length, at least 2
    std::vector<std::string> remarks{}; ///< a line each; programs show or skip them
};

/// Writes text of ERD 2.00 that ProVAL and RoadRuf read: one point a line, millimetres with four
/// decimals, step in metres. read_profile() gives back what is printed, to the last digit.
///
/// The file appears when it is whole, or not at all.
///
/// \throws InputError  if it cannot be written, or an elevation is not finite or over 1e4 m.
void write_erd(const std::filesystem::path& file, const ErdProfile& profile);

} // namespace macadam
