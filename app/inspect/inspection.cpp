#include "app/inspect/inspection.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/foreign/column_mapping_file.hpp"
#include "storage/trips/trip_file_names.hpp"
#include "storage/trips/trip_reader.hpp"
#include "storage/trips/trip_search.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Reads a trip with all its sensors and summarises it.
void add_trip(const TripSource& source, const std::stop_token& stop, Inspection& found) {
    const TripNeeds all{.acc = true, .gyro = true, .speed = true, .fixes = true, .columns = {}};
    try {
        found.trip = summarise(read_trip(source, all, {.report = {}, .stop = stop}));
    } catch (const InputError& error) {
        found.error = error.what();
    }
}

/// Reads the log of another program by what was detected, including what is not sure.
void add_detected(const fs::path& file, const std::stop_token& stop, Inspection& found) {
    const auto extension = file.extension().string();
    found.detected = detect_log(file);
    if (!found.detected) {
        return;
    }
    found.mapping = mapping_toml(
        *found.detected, Confidence::likely, "*" + (extension.empty() ? ".csv" : extension));
    if (!found.detected->time || found.detected->channels.empty()) {
        return;
    }
    auto mapping = parse_mapping(found.mapping, file.string());
    add_trip({.file = file,
              .member = {},
              .files = {file.filename().string()},
              .mapping = std::make_shared<const TripMapping>(std::move(mapping))},
             stop,
             found);
}

Inspection inspection_of_file(const fs::path& file, const std::stop_token& stop) {
    Inspection found{.name = file.string(), .kind = {}, .mapping = {}, .error = {}};
    try {
        found.kind = kind_of_file(file);
        if (found.kind.use == FileKind::Use::trip) {
            add_trip({.file = file, .member = {}}, stop, found);
        } else if (found.kind.use == FileKind::Use::table) {
            add_detected(file, stop, found);
        }
    } catch (const InputError& error) {
        found.error = error.what();
    }
    return found;
}

Inspection inspection_of_trip(const TripSource& source, const std::stop_token& stop) {
    const bool is_export = !source.files.empty() && !source.mapping;
    Inspection found{.name = source.name(),
                     .kind = {FileKind::Use::trip,
                              is_export ? "phone export (phyphox or Sensor Logger)" : "trip log",
                              ""},
                     .mapping = {},
                     .error = {}};
    add_trip(source, stop, found);
    return found;
}

/// Regular files below a folder, in byte order, that are no part of its trips.
std::vector<fs::path> files_beside(const fs::path& folder, const std::vector<TripSource>& trips) {
    std::set<fs::path> taken;
    for (const auto& trip : trips) {
        taken.insert(trip.file.lexically_normal());
        for (const auto& file : trip.files) {
            taken.insert((trip.mapping ? trip.file.parent_path() / file : trip.file / file)
                             .lexically_normal());
        }
    }
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        if (entry.is_regular_file() && !taken.contains(entry.path().lexically_normal())) {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

void inspect_many(const fs::path& path,
                  std::size_t max_files,
                  const std::stop_token& stop,
                  const std::function<void(const Inspection&)>& tell) {
    TripWalk walk{path, {.tracks = true, .max_files = max_files}};
    std::vector<TripSource> trips;
    std::size_t count = 0;
    while (auto trip = walk.next()) {
        if (stop.stop_requested()) {
            return;
        }
        ++count;
        tell(trip->mapping ? inspection_of_file(trip->file, stop)
                           : inspection_of_trip(*trip, stop));
        trip->contents.reset(); // large
        trips.push_back(std::move(*trip));
    }
    for (const auto& file :
         fs::is_directory(path) ? files_beside(path, trips) : std::vector<fs::path>{}) {
        if (stop.stop_requested()) {
            return;
        }
        if (!is_archive_name(file.filename().string())) {
            ++count;
            tell(inspection_of_file(file, stop));
        }
    }
    if (count == 0) {
        tell({.name = path.string(),
              .kind = {FileKind::Use::unknown,
                       "nothing to read",
                       "it contains no trip log and no phone export"},
              .mapping = {},
              .error = {}});
    }
}

} // namespace

void inspect(const fs::path& path,
             std::size_t max_files,
             const std::stop_token& stop,
             const std::function<void(const Inspection&)>& tell) {
    try {
        if (fs::is_directory(path) ||
            (fs::exists(path) && is_archive_name(path.filename().string()))) {
            inspect_many(path, max_files, stop, tell);
        } else {
            tell(inspection_of_file(path, stop));
        }
    } catch (const InputError& error) {
        tell({.name = path.string(), .kind = {}, .mapping = {}, .error = error.what()});
    } catch (const fs::filesystem_error& error) {
        tell({.name = path.string(),
              .kind = {},
              .mapping = {},
              .error = path.string() + ": cannot be read: " + error.code().message()});
    }
}

} // namespace macadam
