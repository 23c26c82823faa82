#include "storage/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/byte_stream.hpp"
#include "storage/foreign/cells.hpp"
#include "storage/foreign/gpx_reader.hpp"
#include "storage/foreign/phone_export.hpp"
#include "storage/foreign/trip_mapping.hpp"
#include "storage/rawlog_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <map>
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
    static constexpr std::string_view suffixes[] = {
        ".trip.csv", ".trip.csv.gz", ".trip.csv.zst", rawlog_suffix};
    return ends_with_one(name, suffixes);
}

bool is_track_name(std::string_view name) {
    return is_trip_name(name) || is_gpx_name(name);
}

/// Which names of files are those of trips.
using NameTest = bool (*)(std::string_view);

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

bool is_zip_name(std::string_view name) {
    return name.ends_with(".zip");
}

std::pair<std::string, std::string> folder_and_file(const std::string& name) {
    const auto size = name.rfind('/') + 1; // 0 where there is none
    return {name.substr(0, size), name.substr(size)};
}

/// Exports of phones among file names: the folder of each, "" or with a '/' at its end, and its
/// files as they are called in it.
std::map<std::string, std::vector<std::string>> exports_in(const std::vector<std::string>& names) {
    std::map<std::string, std::vector<std::string>> exports;
    for (const auto& name : names) {
        if (const auto [folder, file] = folder_and_file(name); marks_export(file)) {
            exports[folder];
        }
    }
    for (auto& [folder, files] : exports) {
        for (const auto& name : names) {
            if (name.starts_with(folder) && belongs_to_export(name.substr(folder.size()))) {
                files.push_back(name.substr(folder.size()));
            }
        }
        std::sort(files.begin(), files.end());
    }
    return exports;
}

using NamedTrips = std::vector<std::pair<std::string, TripSource>>;

/// The exports in an archive that lies in a searched folder. One that cannot be read is handed on,
/// for the reader to say so.
NamedTrips exports_in_zip(const fs::path& zip, const std::string& name) {
    NamedTrips trips;
    try {
        for (auto& [folder, files] : exports_in(members_of(zip))) {
            trips.emplace_back(name + "/" + folder,
                               TripSource{.file = zip, .member = folder, .files = files});
        }
    } catch (const InputError&) {
        trips.emplace_back(name, TripSource{.file = zip, .member = {}});
    }
    return trips;
}

std::vector<std::string> files_under(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        if (!entry.is_directory()) {
            names.push_back(entry.path().lexically_relative(folder).generic_string());
        }
    }
    return names;
}

TripSearch find_in_folder(const fs::path& folder, NameTest is_trip) {
    NamedTrips trips;
    const auto names = files_under(folder);
    auto other_files = names.size();
    for (const auto& name : names) {
        const bool dangles = !fs::exists(folder / name); // a link; the reader says so
        if (!fs::is_regular_file(folder / name) && !dangles) {
            continue;
        }
        if (is_trip(name)) {
            trips.emplace_back(name, TripSource{.file = folder / name, .member = {}});
            --other_files;
        } else if (is_zip_name(name) && !dangles) {
            auto zipped = exports_in_zip(folder / name, name);
            other_files -= zipped.empty() ? 0 : 1;
            std::move(zipped.begin(), zipped.end(), std::back_inserter(trips));
        }
    }
    for (auto& [inside, files] : exports_in(names)) {
        const auto place = inside.empty() ? folder : folder / inside.substr(0, inside.size() - 1);
        trips.emplace_back(inside, TripSource{.file = place, .member = {}, .files = files});
        other_files -= files.size();
    }
    return found(std::move(trips), other_files);
}

TripSearch find_in_archive(const fs::path& archive, NameTest is_trip) {
    NamedTrips trips;
    const auto names = members_of(archive);
    auto other_files = names.size();
    for (const auto& name : names) {
        if (is_trip(name)) {
            trips.emplace_back(name, TripSource{.file = archive, .member = name});
            --other_files;
        }
    }
    for (auto& [folder, files] : exports_in(names)) {
        trips.emplace_back(folder, TripSource{.file = archive, .member = folder, .files = files});
        other_files -= files.size();
    }
    return found(std::move(trips), other_files);
}

/// The file of one of the mapping's later tables that lies beside a file of its first.
std::string companion(const std::string& file, const TripMapping& mapping, std::size_t table) {
    auto name = mapping.tables[table].file;
    if (const auto star = name.find('*'); star != std::string::npos) {
        name.replace(star, 1, star_of(file, mapping.tables.front().file));
    }
    return name;
}

/// A trip of a mapping: the file of its first table and those beside it.
TripSource mapped_trip(const fs::path& path,
                       const std::string& member,
                       const std::shared_ptr<const TripMapping>& mapping) {
    TripSource source{.file = path, .member = member, .files = {}, .mapping = mapping};
    const auto file = member.empty() ? path.filename().string() : folder_and_file(member).second;
    source.files.push_back(file);
    for (std::size_t table = 1; table < mapping->tables.size(); ++table) {
        source.files.push_back(companion(file, *mapping, table));
        const auto beside = path.parent_path() / source.files.back();
        if (member.empty() && !fs::exists(beside)) {
            throw InputError{fmt::format("{}: no such file, expected it beside {}",
                                         beside.string(),
                                         path.filename().string())};
        }
    }
    return source;
}

TripSearch find_mapped(const fs::path& path, const std::shared_ptr<const TripMapping>& mapping) {
    const bool is_folder = fs::is_directory(path);
    if (!is_folder && !is_archive_name(path.filename().string())) {
        return {.trips = {mapped_trip(path, "", mapping)}, .other_files = 0};
    }
    const auto names = is_folder ? files_under(path) : members_of(path);
    NamedTrips trips;
    for (const auto& name : names) {
        if (fits(folder_and_file(name).second, mapping->tables.front().file)) {
            trips.emplace_back(name,
                               is_folder ? mapped_trip(path / name, "", mapping)
                                         : mapped_trip(path, name, mapping));
        }
    }
    const auto read = trips.size() * mapping->tables.size();
    return found(std::move(trips), names.size() - std::min(names.size(), read));
}

/// A folder's path without a slash at its end, so that it has a name.
fs::path named(const fs::path& path) {
    return path.has_filename() ? path : path.parent_path();
}

TripSearch
search(const fs::path& path, const std::shared_ptr<const TripMapping>& mapping, NameTest is_trip) {
    try {
        const auto kind = fs::status(path);
        if (!fs::exists(kind)) {
            throw InputError{fmt::format("{}: no such file or folder", path.string())};
        }
        if (mapping) {
            return find_mapped(path, mapping);
        }
        if (fs::is_directory(kind)) {
            return find_in_folder(named(path), is_trip);
        }
    } catch (const fs::filesystem_error& error) {
        throw InputError{
            fmt::format("{}: cannot be read: {}", error.path1().string(), error.code().message())};
    }
    if (is_archive_name(path.filename().string())) {
        return find_in_archive(path, is_trip);
    }
    return {.trips = {TripSource{.file = path, .member = {}}}, .other_files = 0};
}

} // namespace

TripSearch find_trips(const fs::path& path, const std::shared_ptr<const TripMapping>& mapping) {
    return search(path, mapping, is_trip_name);
}

TripSearch find_tracks(const fs::path& path, const std::shared_ptr<const TripMapping>& mapping) {
    return search(path, mapping, is_track_name);
}

} // namespace macadam
