#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// What a profile file says before its first point.
struct ProfileHead {
    std::vector<std::string> tracks; ///< "left", "right", "profile", or as the file has it
    std::optional<double> step_m;    ///< the file or the caller states it; else stations tell
};

/// The points of a profile file from front to back, in the memory of one.
class ProfileRows {
public:
    ProfileRows() = default;
    ProfileRows(const ProfileRows&) = delete;
    ProfileRows& operator=(const ProfileRows&) = delete;
    virtual ~ProfileRows() = default;

    virtual const ProfileHead& head() const = 0;

    /// The station and an elevation for each track, in metres; stations rise. Good until the next
    /// call. Empty at the end.
    ///
    /// \throws InputError  "file:line: ..." for what is no number, or a row of another length.
    virtual std::span<const double> next() = 0;
};

/// By the name's ending, whatever its case: .csv, .txt, .erd, .pro.
///
/// \param step_m  .csv and .txt: the file has no stations, and its rows are this far apart.
///                .erd and .pro: stands for the step in the file's head.
std::unique_ptr<ProfileRows> open_profile(const std::filesystem::path& file,
                                          std::optional<double> step_m);

// One for each form; see docs/reference/profiles.md.
std::unique_ptr<ProfileRows> open_csv_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);
std::unique_ptr<ProfileRows> open_txt_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);
std::unique_ptr<ProfileRows> open_erd_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);
std::unique_ptr<ProfileRows> open_pro_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m);

/// The words of metres_in, for messages.
inline constexpr std::string_view length_units = "m, cm, mm, um, ft, in or mil";

} // namespace macadam
