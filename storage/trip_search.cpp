#include "storage/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/byte_stream.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace macadam {

namespace {

namespace fs = std::filesystem;

template <std::size_t count>
bool ends_with_one(std::string_view name, const std::string_view (&suffixes)[count]) {
    return std::any_of(std::begin(suffixes), std::end(suffixes), [&](std::string_view suffix) {
        return name.ends_with(suffix);
    });
}

bool is_trip_name(std::string_view name) {
    static constexpr std::string_view suffixes[] = {".trip.csv", ".trip.csv.gz", ".trip.csv.zst"};
    return ends_with_one(name, suffixes);
}

bool is_archive_name(std::string_view name) {
    static constexpr std::string_view suffixes[] = {".zip", ".tar", ".tar.gz", ".tgz", ".tar.zst"};
    return ends_with_one(name, suffixes);
}

/// Trips under their names, which order them.
TripSearch found(std::vector<std::pair<std::string, TripSource>> trips, std::size_t other_files) {
    const auto by_name = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(trips.begin(), trips.end(), by_name);
    TripSearch search{.trips = {}, .other_files = other_files};
    for (auto& trip : trips) {
        search.trips.push_back(std::move(trip.second));
    }
    return search;
}

TripSearch find_in_folder(const fs::path& folder) {
    std::vector<std::pair<std::string, TripSource>> trips;
    std::size_t other_files = 0;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        if (entry.is_directory()) {
            continue;
        }
        const auto name = entry.path().lexically_relative(folder).generic_string();
        if (entry.is_regular_file() && is_trip_name(name)) {
            trips.emplace_back(name, TripSource{.file = entry.path(), .member = {}});
        } else {
            ++other_files;
        }
    }
    return found(std::move(trips), other_files);
}

TripSearch find_in_archive(const fs::path& archive) {
    std::vector<std::pair<std::string, TripSource>> trips;
    std::size_t other_files = 0;
    for (auto& name : members_of(archive)) {
        if (is_trip_name(name)) {
            trips.emplace_back(name, TripSource{.file = archive, .member = name});
        } else {
            ++other_files;
        }
    }
    return found(std::move(trips), other_files);
}

} // namespace

TripSearch find_trips(const fs::path& path) {
    try {
        const auto kind = fs::status(path);
        if (!fs::exists(kind)) {
            throw InputError{fmt::format("{}: no such file or folder", path.string())};
        }
        if (fs::is_directory(kind)) {
            return find_in_folder(path);
        }
    } catch (const fs::filesystem_error& error) {
        throw InputError{
            fmt::format("{}: cannot be read: {}", error.path1().string(), error.code().message())};
    }
    if (is_archive_name(path.filename().string())) {
        return find_in_archive(path);
    }
    return {.trips = {TripSource{.file = path, .member = {}}}, .other_files = 0};
}

} // namespace macadam
