#include "storage/trips/archived_trips.hpp"

#include "estimator/common/error.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/trips/detection/detected_mapping.hpp"
#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/source/phone_export_files.hpp"
#include "storage/trips/source/trip_contents.hpp"
#include "storage/trips/trip_file_names.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <new>
#include <set>
#include <utility>

namespace macadam {

namespace {

// Files of one export are usually consecutive. Otherwise incomplete exports are kept until they
// exceed this memory.
constexpr std::size_t max_waiting_bytes = std::size_t{64} << 20;

using Files = std::vector<TripContents::File>;

/// Reads the current file.
TripContents::File read(ArchiveFiles& files, const std::string& name) {
    try {
        return {name, files.content(), ""};
    } catch (const InputError& error) {
        return {name, "", error.what()};
    } catch (const std::bad_alloc&) {
        return {name, "", name + ": not enough memory"};
    }
}

std::shared_ptr<const TripContents> contents_of(Files files) {
    return std::make_shared<const TripContents>(TripContents{std::move(files)});
}

/// File of a mapping's first table that belongs to a file of a later table.
std::string first_beside(const std::string& file, const TableMapping& table, std::string first) {
    if (const auto star = first.find('*'); star != std::string::npos) {
        first.replace(star, 1, star_of(file, table.file));
    }
    return first;
}

} // namespace

/// Files of trips that are still incomplete.
struct ArchivedTrips::Shelf {
    std::map<std::string, Files> exports;            ///< by folder
    std::map<std::string, TripContents::File> files; ///< of a mapping, by path
    std::set<std::string> firsts;                    ///< those of the first table
    std::size_t bytes = 0;                           ///< in exports
};

ArchivedTrips::ArchivedTrips(std::filesystem::path archive, Sought sought)
    : archive_{std::move(archive)}, sought_{std::move(sought)}, shelf_{std::make_unique<Shelf>()} {}

ArchivedTrips::~ArchivedTrips() = default;

std::optional<TripSource> ArchivedTrips::next() {
    try {
        if (!std::exchange(begun_, true)) {
            files_ = std::make_unique<ArchiveFiles>(archive_, sought_.max_files);
        }
        while (ready_.empty() && !ended_) {
            if (const auto name = files_->next()) {
                take(*name);
            } else {
                end();
                search_again();
            }
        }
    } catch (const InputError& error) {
        end();
        refuse("", error.what());
    }
    if (ready_.empty()) {
        return std::nullopt;
    }
    has_trips_ = true;
    auto trip = std::move(ready_.front());
    ready_.pop_front();
    return trip;
}

void ArchivedTrips::take(const std::string& name) {
    if (detects_) {
        take_detected(name);
    } else if (sought_.mapping) {
        take_for_mapping(name);
    } else if (sought_.is_log != nullptr && sought_.is_log(name)) {
        take_log(name);
    } else if (!place_in_export(name).second.empty()) {
        take_for_export(name);
    } else if (sought_.is_log != nullptr && is_archive_name(name)) {
        refuse(name,
               fmt::format("{}/{}: is an archive within an archive, which is not supported; "
                           "expected it beside the other",
                           archive_.string(),
                           name));
    } else {
        pass_over(name);
    }
}

void ArchivedTrips::pass_over(const std::string& name) {
    has_tables_ = has_tables_ || is_table_name(name);
    if (other_files_++ == 0) {
        first_other_file_ = name;
    }
}

void ArchivedTrips::take_log(const std::string& name) {
    Files files;
    files.push_back(read(*files_, ""));
    ready_.push_back({.file = archive_, .member = name, .contents = contents_of(std::move(files))});
}

void ArchivedTrips::take_detected(const std::string& name) {
    if (!is_table_name(name)) {
        pass_over(name);
        return;
    }
    const auto file = folder_and_file(name).second;
    Files files;
    files.push_back(read(*files_, file));
    const auto contents = contents_of(std::move(files));
    std::shared_ptr<const TripMapping> mapping;
    if (contents->files.front().refusal.empty()) { // a damaged file is none of a known make
        const auto sample = read_text_sample(*bytes_of(contents, file), name);
        mapping = mapping_of_found(sample ? detect_log(*sample) : std::nullopt);
    }
    if (!mapping) {
        pass_over(name);
        return;
    }
    ready_.push_back({.file = archive_,
                      .member = name,
                      .files = {file},
                      .mapping = std::move(mapping),
                      .contents = contents});
}

/// Begins the second pass, if the first found CSV files alone.
void ArchivedTrips::search_again() {
    const bool is_wanted = sought_.is_log != nullptr && !sought_.mapping && !detects_ &&
                           !has_trips_ && ready_.empty() && has_tables_;
    if (is_wanted) {
        detects_ = true;
        ended_ = false;
        other_files_ = 0;
        first_other_file_.clear();
        files_ = std::make_unique<ArchiveFiles>(archive_, sought_.max_files);
    }
}

/// Adds a file to its export; a second file of the same name begins another export.
void ArchivedTrips::take_for_export(const std::string& name) {
    const auto [folder, file] = place_in_export(name);
    auto& waiting = shelf_->exports;
    const auto is_here = [&, &wanted = file](const auto& f) { return f.name == wanted; };
    if (const auto found = waiting.find(folder);
        found != waiting.end() && std::ranges::any_of(found->second, is_here)) {
        hand_out_export(folder);
    }
    auto& files = waiting[folder];
    files.push_back(read(*files_, file));
    shelf_->bytes += files.back().bytes.size();
    while (shelf_->bytes > max_waiting_bytes && waiting.size() > 1) {
        const bool is_at_hand = waiting.begin()->first == folder;
        hand_out_export((is_at_hand ? std::next(waiting.begin()) : waiting.begin())->first);
    }
}

void ArchivedTrips::hand_out_export(const std::string& folder) {
    const auto place = folder; // copy, because the original is erased
    auto files = std::move(shelf_->exports.extract(place).mapped());
    std::ranges::sort(files, {}, &TripContents::File::name);
    std::vector<std::string> names;
    for (const auto& file : files) {
        names.push_back(file.name);
        shelf_->bytes -= file.bytes.size();
    }
    if (std::ranges::none_of(names, marks_export)) {
        for (const auto& name : names) {
            pass_over(place + name);
        }
        return;
    }
    ready_.push_back({.file = archive_,
                      .member = place,
                      .files = std::move(names),
                      .contents = contents_of(std::move(files))});
}

void ArchivedTrips::take_for_mapping(const std::string& name) {
    const auto& tables = sought_.mapping->tables;
    const auto [folder, file] = folder_and_file(name);
    const auto table = std::ranges::find_if(
        tables, [&, &wanted = file](const TableMapping& t) { return fits(wanted, t.file); });
    if (table == tables.end()) {
        pass_over(name);
        return;
    }
    if (table == tables.begin()) {
        if (shelf_->files.contains(name)) { // files of equal names belong to different trips
            hand_out_mapped(name, true);
        }
        shelf_->firsts.insert(name);
    }
    shelf_->files[name] = read(*files_, file);
    if (table == tables.begin()) {
        hand_out_mapped(name, false);
    } else if (table->file.find('*') != std::string::npos) {
        const auto first = folder + first_beside(file, *table, tables.front().file);
        if (shelf_->firsts.contains(first)) {
            hand_out_mapped(first, false);
        }
    } else { // of all trips in the folder
        auto first = shelf_->firsts.lower_bound(folder);
        while (first != shelf_->firsts.end() && first->starts_with(folder)) {
            hand_out_mapped(std::string{*first++}, false);
        }
    }
}

/// Returns a trip of a mapping. A file whose name has no '*' may belong to several trips and is
/// kept.
void ArchivedTrips::hand_out_mapped(const std::string& first, bool even_if_incomplete) {
    const auto& mapping = *sought_.mapping;
    const auto [folder, file] = folder_and_file(first);
    TripSource source{
        .file = archive_, .member = first, .files = {file}, .mapping = sought_.mapping};
    for (std::size_t table = 1; table < mapping.tables.size(); ++table) {
        source.files.push_back(companion(file, mapping, table));
    }
    Files files;
    auto& waiting = shelf_->files;
    for (const auto& name : source.files) {
        if (const auto found = waiting.find(folder + name); found != waiting.end()) {
            files.push_back(found->second);
        } else if (!even_if_incomplete) {
            return;
        }
    }
    for (std::size_t table = 0; table < source.files.size(); ++table) {
        if (table == 0 || mapping.tables[table].file.find('*') != std::string::npos) {
            waiting.erase(folder + source.files[table]);
        }
    }
    shelf_->firsts.erase(first);
    source.contents = contents_of(std::move(files));
    ready_.push_back(std::move(source));
}

void ArchivedTrips::refuse(const std::string& member, const std::string& words) {
    ready_.push_back(
        {.file = archive_, .member = member, .contents = contents_of({{"", "", words}})});
}

/// Handles the end of the archive.
void ArchivedTrips::end() {
    ended_ = true;
    while (!shelf_->exports.empty()) {
        hand_out_export(shelf_->exports.begin()->first);
    }
    for (const auto& first : std::set{shelf_->firsts}) {
        hand_out_mapped(first, true);
    }
}

} // namespace macadam
