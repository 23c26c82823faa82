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

/// Part of a report that shows photos of a road.
struct PhotoPlaceholder {
    const std::vector<GeoPoint>* line;
    double from_m; ///< chainage of its beginning
    std::vector<ReportPhoto>* photos;
};

/// Photo and where it is shown.
struct PlacedPhoto {
    fs::path file;
    PhotoPlace place;
    std::size_t at;
    LineFoot foot;
};

/// Returns the worst sections, and after them the parts of a strip chart.
std::vector<PhotoPlaceholder> placeholders_of(Report& report) {
    std::vector<PhotoPlaceholder> found;
    for (auto& section : report.worst) {
        found.push_back({&section.stretch.line, 0, &section.photos});
    }
    for (auto& strip : report.strips) {
        if (!strip.line.empty()) {
            found.push_back({&strip.line, strip.from_m, &strip.photos});
        }
    }
    return found;
}

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

/// Returns the photo at the road nearest to it, the first of several; none if all are too far.
std::optional<PlacedPhoto> placed(const fs::path& file,
                                  const PhotoPlace& place,
                                  const std::vector<PhotoPlaceholder>& placeholders) {
    constexpr double as_near_m = 0.01;
    std::optional<PlacedPhoto> nearest;
    for (std::size_t i = 0; i < placeholders.size(); ++i) {
        const auto foot = foot_on(*placeholders[i].line, place.at);
        if (foot.distance_m <= max_photo_distance_m &&
            (!nearest || foot.distance_m < nearest->foot.distance_m - as_near_m)) {
            nearest = {file, place, i, foot};
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

PhotoCounts add_photos(const fs::path& folder, Report& report, const Progress& progress) {
    PhotoCounts counts;
    const auto placeholders = placeholders_of(report);
    const auto files = files_in(folder);
    counts.files = files.size();
    std::vector<PlacedPhoto> photos;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the report was complete"};
        }
        try {
            if (auto photo = placed(files[i], read_photo_place(files[i]), placeholders)) {
                photos.push_back(std::move(*photo));
            } else {
                ++counts.elsewhere;
            }
        } catch (const InputError& error) {
            counts.skipped.emplace_back(error.what());
        }
        progress(i + 1, files.size());
    }
    std::ranges::stable_sort(
        photos, {}, [](const PlacedPhoto& photo) { return photo.foot.distance_m; });
    for (const auto& photo : photos) {
        const auto& [line, from_m, shown] = placeholders[photo.at];
        if (shown->size() == max_photos_a_section) {
            ++counts.too_many;
            continue;
        }
        try {
            auto [jpeg, width_px, height_px] = reduce_photo(photo.file, photo_px);
            shown->push_back({.jpeg = std::move(jpeg),
                              .width_px = width_px,
                              .height_px = height_px,
                              .day = photo.place.day,
                              .distance_m = photo.foot.distance_m,
                              .at_m = from_m + photo.foot.along_m});
            ++counts.shown;
        } catch (const InputError& error) {
            counts.skipped.emplace_back(error.what());
        }
    }
    for (auto& strip : report.strips) {
        std::ranges::stable_sort(strip.photos, {}, &ReportPhoto::at_m);
    }
    return counts;
}

std::string photo_words(const PhotoCounts& counts) {
    auto words = fmt::format("photos: {} of {} shown", counts.shown, counts.files);
    if (counts.elsewhere > 0) {
        words += fmt::format(", {} farther than {:.0f} m from all roads listed",
                             counts.elsewhere,
                             max_photo_distance_m);
    }
    if (counts.too_many > 0) {
        words += fmt::format(", {} beyond the nearest {} of a section or strip",
                             counts.too_many,
                             max_photos_a_section);
    }
    if (!counts.skipped.empty()) {
        words += fmt::format(", {} skipped", counts.skipped.size());
    }
    return words;
}

} // namespace macadam
