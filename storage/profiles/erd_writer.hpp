#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Elevations at a constant step, for an ERD file.
struct ErdProfile {
    std::string title;   ///< one line; may be empty
    double start_m = 0;  ///< station of the first point
    double step_m = 0.1; ///< > 0
    struct Channel {
        std::string name; ///< "left" and "right" become "LElev." and "RElev."; others are cut to 8
                          ///< characters
        std::vector<double> elevation_m; ///< finite
    };
    std::vector<Channel> channels;      ///< at least one; equal lengths of at least 2
    std::vector<std::string> remarks{}; ///< one line each; shown or skipped by other programs
};

/// Writes a text file in ERD 2.00 that ProVAL and RoadRuf read: one point per line, in millimetres
/// with four decimals, with the step in metres. read_profile() restores the printed values exactly.
///
/// The file appears complete or not at all.
///
/// \throws InputError  if the file cannot be written, or an elevation is not finite or over 1e4 m.
void write_erd(const std::filesystem::path& file, const ErdProfile& profile);

} // namespace macadam
