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
        std::string name; ///< "left", "right", or the name in the file without "_m"
        std::vector<double> elevation_m;
    };
    std::vector<Track> tracks;         ///< at least one, each as long as station_m
    std::optional<double> even_step_m; ///< if equidistant (within 1e-3 of the step)
};

/// Reads a whole profile file into memory (storage/profiles/profile_rows.hpp reads it point by
/// point).
///
/// .csv: a header row; the first column is station_m unless `step_m` is given, every other column
/// is a track in metres. .txt: the same without a header, separated by blanks. .erd: UMTRI's ERD
/// 2.00, text or binary. .pro: TxDOT's HEAD3. For the last two, `step_m` replaces the step stated
/// in the file.
///
/// \throws InputError  "file:line: ..." for a value that is not a number, a row of another length,
///                     or stations that do not rise.
MeasuredProfile read_profile(const std::filesystem::path& file, std::optional<double> step_m);

/// Extent of a profile file, found in one pass with memory for one point.
struct ProfileExtent {
    std::vector<std::string> tracks;
    std::size_t points; ///< at least 2
    double first_m;
    double last_m;
    std::optional<double> even_step_m; ///< see MeasuredProfile
};

/// Reads the extent of a profile file.
///
/// \throws InputError  as read_profile does.
ProfileExtent extent_of_profile(const std::filesystem::path& file, std::optional<double> step_m);

/// Determines the extent of a profile in memory.
/// \param name  of the profile, for messages
/// \throws InputError  for values that are not finite, or stations that do not rise.
ProfileExtent extent_of_profile(const std::string& name, const MeasuredProfile& profile);

} // namespace macadam
