#include "storage/trips/trip_search.hpp"

#include "estimator/common/error.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/trips/archived_trips.hpp"
#include "storage/trips/detection/detected_mapping.hpp"
#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/paired_positions.hpp"
#include "storage/trips/positions/position_files.hpp"
#include "storage/trips/source/trip_contents.hpp"
#include "storage/trips/trip_file_names.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

namespace macadam {

namespace {

namespace fs = std::filesystem;

bool is_trip_or_track_name(std::string_view name) {
    return is_trip_name(name) || is_track_name(name);
}

/// Predicate for the names of trip files.
using NameTest = bool (*)(std::string_view);

NameTest name_test(const TripWalkConfig& config) {
    return config.tracks ? is_trip_or_track_name : is_trip_name;
}

/// Returns the files of a folder and of the folders below it that may be read.
std::vector<std::string> files_under(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry :
         fs::recursive_directory_iterator{folder, fs::directory_options::skip_permission_denied}) {
        if (!entry.is_directory()) {
            names.push_back(entry.path().lexically_relative(folder).generic_string());
        }
    }
    return names;
}

/// Trip of a mapping: the file of its first table and the files that belong to it.
TripSource mapped_trip(const fs::path& path, const std::shared_ptr<const TripMapping>& mapping) {
    const auto file = path.filename().string();
    TripSource source{.file = path, .member = {}, .files = {file}, .mapping = mapping};
    for (std::size_t table = 1; table < mapping->tables.size(); ++table) {
        source.files.push_back(companion(file, *mapping, table));
        const auto beside = path.parent_path() / source.files.back();
        if (!fs::exists(beside)) {
            throw InputError{fmt::format("{}: no such file, expected it beside {}",
                                         beside.string(),
                                         path.filename().string())};
        }
    }
    return source;
}

/// Trip of a CSV file whose layout is detected for sure.
///
/// \param beside_positions  only if the file is one of two, the other with its positions
std::optional<TripSource> detected_trip(const fs::path& path, bool beside_positions) {
    if (!is_table_name(path.filename().string()) || !fs::is_regular_file(path)) {
        return std::nullopt;
    }
    try {
        const bool has_positions = positions_beside(path).has_value();
        if (is_nmea_file(path) || (beside_positions && !has_positions)) {
            return std::nullopt;
        }
        auto mapping = mapping_of_found(detect_log(path), has_positions);
        return mapping ? std::optional{mapped_trip(path, mapping)} : std::nullopt;
    } catch (const InputError&) { // an unreadable file, which is counted with the others
        return std::nullopt;
    }
}

/// Path of a folder without a final slash, so that it has a name.
fs::path named(const fs::path& path) {
    return path.has_filename() ? path : path.parent_path();
}

} // namespace

TripWalk::TripWalk(const fs::path& path, TripWalkConfig config) : config_{std::move(config)} {
    try {
        const auto kind = fs::status(path);
        if (!fs::exists(kind)) {
            throw InputError{fmt::format("{}: no such file or folder", path.string())};
        }
        const bool is_folder = fs::is_directory(kind);
        if (!is_folder && is_archive_name(path.filename().string())) {
            items_.push_back(
                {.source = {.file = path, .member = {}}, .is_archive = true, .is_log = true});
        } else if (config_.mapping) {
            find_mapped(path);
        } else if (is_folder) {
            find_in_folder(named(path));
        } else {
            items_.push_back({.source = {.file = path, .member = {}}});
            pair(items_.back().source);
        }
    } catch (const fs::filesystem_error& error) {
        throw InputError{
            fmt::format("{}: cannot be read: {}", error.path1().string(), error.code().message())};
    }
    archives_ = static_cast<std::size_t>(std::ranges::count(items_, true, &Item::is_archive));
}

TripWalk::TripWalk(TripWalk&&) noexcept = default;
TripWalk::~TripWalk() = default;

/// Adds the items in the order of their names.
void TripWalk::take(NamedItems items) {
    std::ranges::stable_sort(
        items, {}, [](const auto& item) -> const auto& { return item.first; });
    for (auto& [name, item] : items) {
        items_.push_back(std::move(item));
    }
}

/// Adds the file with the positions of a log, if it has none.
void TripWalk::pair(TripSource& source) const {
    if (config_.positions.empty()) {
        source.positions = paired_positions(source).value_or(fs::path{});
    }
}

/// Pairs the logs of a folder with their positions, which then are no trips and no other files.
void TripWalk::pair_all(const fs::path& folder,
                        NamedItems& items,
                        std::set<std::string>& others) const {
    std::set<fs::path> taken;
    for (auto& [name, item] : items) {
        if (!item.is_archive) {
            pair(item.source);
            taken.insert(item.source.positions);
        }
    }
    taken.erase(fs::path{});
    for (const auto& file : taken) {
        others.erase(file.lexically_relative(folder).generic_string());
    }
    std::erase_if(items, [&](const auto& item) { return taken.contains(item.second.source.file); });
}

/// Adds the positions that were asked for.
TripSource TripWalk::with_positions(TripSource source) const {
    source.positions = config_.positions.empty() ? source.positions : config_.positions;
    if (!config_.positions.empty() && (given_ > 1 || items_.size() > 1)) {
        const auto words =
            fmt::format("{}: is one of several trips, but the positions of {} belong "
                        "to one; give one log",
                        source.name(),
                        config_.positions.string());
        source = {.file = source.file,
                  .member = source.member,
                  .contents =
                      std::make_shared<const TripContents>(TripContents{{{"", "", words}}})};
    }
    return source;
}

/// Counts ignored files.
void TripWalk::take_others(std::size_t count, const std::string& first) {
    if (first_other_file_.empty() && count > 0) {
        first_other_file_ = first;
    }
    other_files_ += count;
}

void TripWalk::find_in_folder(const fs::path& folder) {
    NamedItems items;
    const auto names = files_under(folder);
    std::set<std::string> others{names.begin(), names.end()};
    for (const auto& name : names) {
        const bool dangles = !fs::exists(folder / name); // broken link, reported by the reader
        if (!fs::is_regular_file(folder / name) && !dangles) {
            continue;
        }
        const TripSource source{.file = folder / name, .member = {}};
        if (name_test(config_)(name)) {
            items.emplace_back(name, Item{.source = source});
            others.erase(name);
        } else if (name.ends_with(".zip") && !dangles) { // a broken link was already reported
            items.emplace_back(name, Item{.source = source, .is_archive = true});
            others.erase(name);
        }
    }
    auto exports = exports_in(names);
    const bool has_tracks_only =
        std::ranges::all_of(items, [](const auto& item) { return is_track_name(item.first); });
    if (has_tracks_only && exports.empty()) { // perhaps the logs of another make
        const bool beside_tracks = !items.empty();
        for (std::size_t i = 0; i < names.size() && !config_.search.stop.stop_requested(); ++i) {
            if (auto source = detected_trip(folder / names[i], beside_tracks)) {
                items.emplace_back(names[i], Item{.source = std::move(*source)});
                others.erase(names[i]);
            }
            config_.search(i + 1, names.size());
        }
    }
    for (auto& [inside, files] : exports) {
        const auto place = inside.empty() ? folder : folder / inside.substr(0, inside.size() - 1);
        for (const auto& file : files) {
            others.erase(inside + file);
        }
        items.emplace_back(inside, Item{.source = {.file = place, .member = {}, .files = files}});
    }
    pair_all(folder, items, others);
    take_others(others.size(), others.empty() ? "" : *others.begin());
    take(std::move(items));
}

void TripWalk::find_mapped(const fs::path& path) {
    if (!fs::is_directory(path)) {
        items_.push_back({.source = mapped_trip(path, config_.mapping)});
        pair(items_.back().source);
        return;
    }
    const auto names = files_under(path);
    std::set<std::string> others{names.begin(), names.end()};
    NamedItems items;
    for (const auto& name : names) {
        if (fits(folder_and_file(name).second, config_.mapping->tables.front().file)) {
            items.emplace_back(name, Item{.source = mapped_trip(path / name, config_.mapping)});
            for (const auto& file : items.back().second.source.files) {
                others.erase((fs::path{name}.parent_path() / file).generic_string());
            }
        }
    }
    pair_all(path, items, others);
    take_others(others.size(), others.empty() ? "" : *others.begin());
    take(std::move(items));
}

std::optional<TripSource> TripWalk::next() {
    for (;;) {
        if (archive_) {
            if (auto trip = archive_->next()) {
                ++given_;
                return with_positions(std::move(*trip));
            }
            const bool gave_none = given_ == given_before_archive_;
            const auto& item = items_[next_ - 1];
            if (item.is_log) {
                take_others(archive_->other_files(), archive_->first_other_file());
            } else if (gave_none) {
                take_others(1, item.source.file.filename().string());
            }
            archive_.reset();
            --archives_;
        }
        if (next_ == items_.size()) {
            return std::nullopt;
        }
        const auto& item = items_[next_++];
        if (!item.is_archive) {
            ++given_;
            return with_positions(item.source);
        }
        given_before_archive_ = given_;
        archive_ = std::make_unique<ArchivedTrips>(
            item.source.file,
            ArchivedTrips::Sought{.is_log = item.is_log ? name_test(config_) : nullptr,
                                  .mapping = item.is_log ? config_.mapping : nullptr,
                                  .max_files = config_.max_files});
    }
}

std::optional<std::size_t> TripWalk::count() const {
    return archives_ > 0 ? std::nullopt : std::optional{given_ + items_.size() - next_};
}

std::vector<fs::path> TripWalk::files() const {
    std::vector<fs::path> files;
    for (const auto& item : items_) {
        files.push_back(item.source.file);
    }
    return files;
}

FirstTrip first_trip(const fs::path& path, const TripWalkConfig& config) {
    TripWalk walk{path, config};
    FirstTrip first{.trip = walk.next()};
    first.count = first.trip ? 1 : 0;
    while (!walk.count() && walk.next()) {
        ++first.count;
    }
    return {std::move(first.trip), walk.count().value_or(first.count)};
}

} // namespace macadam
