#include "app/report/section_photos.hpp"

#include "estimator/common/error.hpp"
#include "mapping/geometry/nearest_point.hpp"
#include "storage/photos/photo_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr int photo_px = 640; // of the longer side: 80 mm at 200 dpi

/// Photo and the section that it shows.
struct PlacedPhoto {
    fs::path file;
    PhotoPlace place;
    std::size_t section;
    double distance_m;
};

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator each{folder, error}; !error && each != fs::directory_iterator{};
         each.increment(error)) {
        if (!each->is_directory(error)) {
            files.push_back(each->path());
        }
    }
    if (error) {
        throw InputError{fmt::format("{}: cannot be read: {}", folder.string(), error.message())};
    }
    std::ranges::sort(files);
    return files;
}

/// Returns the photo at the section nearest to it; none if that is too far.
std::optional<PlacedPhoto>
placed(const fs::path& file, const PhotoPlace& place, const std::vector<ReportStretch>& sections) {
    std::optional<PlacedPhoto> nearest;
    double nearest_m = max_photo_distance_m;
    for (std::size_t i = 0; i < sections.size(); ++i) {
        const double distance_m = foot_on(sections[i].stretch.line, place.at).distance_m;
        if (distance_m <= nearest_m) {
            nearest = {file, place, i, distance_m};
            nearest_m = distance_m;
        }
    }
    return nearest;
}

} // namespace

void expect_photo_folder(const fs::path& folder) {
    std::error_code none;
    if (!fs::is_directory(folder, none)) {
        throw InputError{
            fmt::format("{}: is no folder, expected a folder of photos", folder.string())};
    }
}

PhotoCounts
add_photos(const fs::path& folder, std::vector<ReportStretch>& sections, const Progress& progress) {
    PhotoCounts counts;
    const auto files = files_in(folder);
    counts.files = files.size();
    std::vector<PlacedPhoto> photos;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the report was complete"};
        }
        try {
            if (auto photo = placed(files[i], read_photo_place(files[i]), sections)) {
                photos.push_back(std::move(*photo));
            } else {
                ++counts.elsewhere;
            }
        } catch (const InputError& error) {
            counts.skipped.emplace_back(error.what());
        }
        progress(i + 1, files.size());
    }
    std::ranges::stable_sort(photos, {}, &PlacedPhoto::distance_m);
    for (const auto& photo : photos) {
        auto& shown = sections[photo.section].photos;
        if (shown.size() == max_photos_a_section) {
            ++counts.too_many;
            continue;
        }
        try {
            auto [jpeg, width_px, height_px] = reduce_photo(photo.file, photo_px);
            shown.push_back({.jpeg = std::move(jpeg),
                             .width_px = width_px,
                             .height_px = height_px,
                             .day = photo.place.day,
                             .distance_m = photo.distance_m});
            ++counts.shown;
        } catch (const InputError& error) {
            counts.skipped.emplace_back(error.what());
        }
    }
    return counts;
}

std::string photo_words(const PhotoCounts& counts) {
    auto words =
        fmt::format("photos: {} of {} shown at worst sections", counts.shown, counts.files);
    if (counts.elsewhere > 0) {
        words += fmt::format(
            ", {} farther than {:.0f} m from all", counts.elsewhere, max_photo_distance_m);
    }
    if (counts.too_many > 0) {
        words += fmt::format(
            ", {} beyond the nearest {} of a section", counts.too_many, max_photos_a_section);
    }
    if (!counts.skipped.empty()) {
        words += fmt::format(", {} skipped", counts.skipped.size());
    }
    return words;
}

} // namespace macadam
