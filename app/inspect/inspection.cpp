#include "app/inspect/inspection.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/archive.hpp"
#include "storage/files/decompress.hpp"
#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/paired_positions.hpp"
#include "storage/trips/source/trip_contents.hpp"
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
    const TripNeeds all{.acc = true, .gyro = true, .speed = true, .fixes = true};
    try {
        found.trip = summarise(read_trip(source, all, {.report = {}, .stop = stop}));
    } catch (const InputError& error) {
        found.error = error.what();
    }
}

std::optional<TextSample> sample_of(const TripSource& source) {
    const auto bytes = source.contents ? bytes_of(source.contents, source.files.front())
                                       : decompressed(file_bytes(source.file), source.name());
    return read_text_sample(*bytes, source.name());
}

/// Reads the log of another program by what was detected, including what is not sure.
///
/// \param source  a file, or its contents, without a mapping.
void add_detected(TripSource source, const std::stop_token& stop, Inspection& found) {
    const auto sample = sample_of(source);
    found.detected = sample ? detect_log(*sample) : std::nullopt;
    if (!found.detected) {
        return;
    }
    const auto extension = fs::path{source.files.front()}.extension().string();
    found.mapping = mapping_toml(
        *found.detected, Confidence::likely, "*" + (extension.empty() ? ".csv" : extension));
    if (!found.detected->time || found.detected->channels.empty()) {
        return;
    }
    source.mapping =
        std::make_shared<const TripMapping>(parse_mapping(found.mapping, source.name()));
    source.positions = paired_positions(source).value_or(fs::path{});
    found.has_positions = !source.positions.empty();
    add_trip(source, stop, found);
}

Inspection inspection_of_file(const fs::path& file, const std::stop_token& stop) {
    Inspection found{.name = file.string(), .kind = {}, .mapping = {}, .error = {}};
    try {
        found.kind = kind_of_file(file);
        if (found.kind.use == FileKind::Use::trip) {
            TripSource source{.file = file, .member = {}};
            source.positions = paired_positions(source).value_or(fs::path{});
            add_trip(source, stop, found);
        } else if (found.kind.use == FileKind::Use::table) {
            add_detected(
                {.file = file, .member = {}, .files = {file.filename().string()}}, stop, found);
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
                              is_export        ? "phone export (phyphox or Sensor Logger)"
                              : source.mapping ? "log of another program, by its mapping"
                                               : "trip log",
                              ""},
                     .mapping = {},
                     .error = {}};
    add_trip(source, stop, found);
    return found;
}

/// Inspects the CSV files of an archive.
///
/// \returns their number.
std::size_t inspect_tables(const fs::path& archive,
                           std::size_t max_files,
                           const std::stop_token& stop,
                           const std::function<void(const Inspection&)>& tell) {
    ArchiveFiles files{archive, max_files};
    std::size_t count = 0;
    while (const auto name = stop.stop_requested() ? std::nullopt : files.next()) {
        if (!is_table_name(*name)) {
            continue;
        }
        ++count;
        Inspection found{.name = (archive / *name).string(),
                         .kind = {FileKind::Use::table, "CSV file of another program", ""},
                         .mapping = {},
                         .error = {}};
        try {
            const auto file = folder_and_file(*name).second;
            const auto contents =
                std::make_shared<const TripContents>(TripContents{{{file, files.content(), ""}}});
            add_detected({.file = archive, .member = *name, .files = {file}, .contents = contents},
                         stop,
                         found);
            if (!found.detected) {
                found.kind = {FileKind::Use::unknown, "not a table", ""};
            }
        } catch (const InputError& error) {
            found.error = error.what();
        }
        tell(found);
    }
    return count;
}

/// Regular files below a folder, in byte order, that are no part of its trips.
std::vector<fs::path> files_beside(const fs::path& folder, const std::vector<TripSource>& trips) {
    std::set<fs::path> taken;
    for (const auto& trip : trips) {
        taken.insert(trip.file.lexically_normal());
        taken.insert(trip.positions.lexically_normal());
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
                  const Progress& search,
                  const std::function<void(const Inspection&)>& tell) {
    const auto& stop = search.stop;
    const bool is_folder = fs::is_directory(path);
    TripWalk walk{path, {.tracks = true, .max_files = max_files, .search = search}};
    std::vector<TripSource> trips;
    std::size_t count = 0;
    while (auto trip = walk.next()) {
        if (stop.stop_requested()) {
            return;
        }
        if (trip->mapping && !is_folder) {
            break; // the CSV files of an archive
        }
        ++count;
        tell(trip->mapping ? inspection_of_file(trip->file, stop)
                           : inspection_of_trip(*trip, stop));
        trip->contents.reset(); // large
        trips.push_back(std::move(*trip));
    }
    if (!is_folder && count == 0) {
        count = inspect_tables(path, max_files, stop, tell);
    }
    for (const auto& file : is_folder ? files_beside(path, trips) : std::vector<fs::path>{}) {
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
             const std::shared_ptr<const TripMapping>& mapping,
             std::size_t max_files,
             const Progress& search,
             const std::function<void(const Inspection&)>& tell) {
    try {
        if (mapping) {
            TripWalk walk{path, {.mapping = mapping, .max_files = max_files, .search = search}};
            while (const auto trip = search.stop.stop_requested() ? std::nullopt : walk.next()) {
                tell(inspection_of_trip(*trip, search.stop));
            }
        } else if (fs::is_directory(path) ||
                   (fs::exists(path) && is_archive_name(path.filename().string()))) {
            inspect_many(path, max_files, search, tell);
        } else {
            tell(inspection_of_file(path, search.stop));
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
