#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Measured elevations of one or more wheel tracks at common stations.
struct MeasuredProfile {
    std::vector<double> station_m; ///< rising
    struct Track {
        std::string name; ///< "left", "right", or as the file has it, without "_m"
        std::vector<double> elevation_m;
    };
    std::vector<Track> tracks;         ///< at least one, each as long as station_m
    std::optional<double> even_step_m; ///< where the stations are even (within 1e-3 of the step)
};

/// .csv: a header row; first column station_m unless `step_m` is given, every other column one
/// track in metres. .txt: the same without a header, blanks between.
///
/// \throws InputError  "file:line: ..." for what is not a number, a row of another length, or
///                     stations that do not rise.
MeasuredProfile read_profile(const std::filesystem::path& file, std::optional<double> step_m);

} // namespace macadam
