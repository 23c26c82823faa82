#pragma once

#include <cstddef>
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

/// The whole of a profile file in memory (storage/profiles/profile_rows.hpp reads it point by
/// point).
///
/// .csv: a header row; first column station_m unless `step_m` is given, every other column one
/// track in metres. .txt: the same without a header, blanks between. .erd: UMTRI's ERD 2.00, text
/// or binary. .pro: TxDOT's HEAD3. In the last two `step_m` stands for the step that they state.
///
/// \throws InputError  "file:line: ..." for what is not a number, a row of another length, or
///                     stations that do not rise.
MeasuredProfile read_profile(const std::filesystem::path& file, std::optional<double> step_m);

/// How far a profile file reaches; read through once, in the memory of one point.
struct ProfileExtent {
    std::vector<std::string> tracks;
    std::size_t points; ///< at least 2
    double first_m;
    double last_m;
    std::optional<double> even_step_m; ///< as above
};

/// \throws InputError  as read_profile does.
ProfileExtent extent_of_profile(const std::filesystem::path& file, std::optional<double> step_m);

} // namespace macadam
