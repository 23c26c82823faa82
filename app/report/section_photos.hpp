#pragma once

#include "estimator/common/progress.hpp"
#include "render/report/report.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

inline constexpr double max_photo_distance_m = 30;     ///< of a photo from the road that it shows
inline constexpr std::size_t max_photos_a_section = 3; ///< the nearest

/// Numbers of files in a folder of photos, by what became of them.
struct PhotoCounts {
    std::size_t files = 0;
    std::size_t shown = 0;
    std::size_t elsewhere = 0;          ///< farther from all roads listed than the limit
    std::size_t too_many = 0;           ///< beyond the number of a section or strip
    std::vector<std::string> skipped{}; ///< messages, each "FILE: WHAT"
};

/// \throws InputError  if there is no such folder.
void expect_photo_folder(const std::filesystem::path& folder);

/// Adds the photos of a folder, without its subfolders, to the nearest of a report's worst sections
/// and strips. Files that are no photos, tell no position or are damaged are skipped.
///
/// \param progress     counts files
/// \throws InputError  if the folder cannot be read, and on a stop request.
PhotoCounts
add_photos(const std::filesystem::path& folder, Report& report, const Progress& progress);

/// Sums up the counts in one line.
std::string photo_words(const PhotoCounts& counts);

} // namespace macadam
