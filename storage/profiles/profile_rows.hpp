#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

struct MeasuredProfile; // storage/profiles/profile_reader.hpp

/// Information in a profile file that precedes its first point.
struct ProfileHead {
    std::vector<std::string> tracks; ///< "left", "right", "profile", or the name in the file
    std::optional<double> step_m;    ///< stated by file or caller; otherwise see the stations
};

/// Reads the points of a profile file in sequence, with memory for one point.
class ProfileRows {
public:
    ProfileRows() = default;
    ProfileRows(const ProfileRows&) = delete;
    ProfileRows& operator=(const ProfileRows&) = delete;
    virtual ~ProfileRows() = default;

    virtual const ProfileHead& head() const = 0;

    /// Returns the station and one elevation per track, in metres; stations rise. Valid until the
    /// next call; empty at the end.
    ///
    /// \throws InputError  "file:line: ..." for a value that is not a number, or a row of another
    ///                     length.
    virtual std::span<const double> next() = 0;
};

/// Opens a profile file by its suffix, in any case: .csv, .txt, .erd, .pro.
///
/// \param step_m  .csv and .txt: the file has no stations, and its rows have this spacing. .erd and
///                .pro: replaces the step in the header of the file.
std::unique_ptr<ProfileRows> open_profile(const std::filesystem::path& file,
                                          std::optional<double> step_m);

/// Reads the points of a profile in memory, which must outlive the reader.
///
/// \throws InputError  from next(), for an elevation that is not finite.
std::unique_ptr<ProfileRows> rows_of_profile(const MeasuredProfile& profile);

// Readers of each format; see docs/reference/profiles.md.
std::unique_ptr<ProfileRows> open_csv_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);
std::unique_ptr<ProfileRows> open_txt_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);
std::unique_ptr<ProfileRows> open_erd_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);
std::unique_ptr<ProfileRows> open_pro_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);

/// Units of metres_in, for messages.
inline constexpr std::string_view length_units = "m, cm, mm, um, ft, in or mil";

} // namespace macadam
