#include "storage/trips/trip_file_names.hpp"

#include "estimator/common/ascii.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"
#include "storage/trips/source/phone_export_files.hpp"

#include <algorithm>
#include <iterator>

namespace macadam {

namespace {

template <std::size_t count>
bool ends_with_one(std::string_view name, const std::string_view (&suffixes)[count]) {
    return std::any_of(std::begin(suffixes), std::end(suffixes), [&](std::string_view suffix) {
        return name.ends_with(suffix);
    });
}

} // namespace

bool is_trip_name(std::string_view name) {
    static constexpr std::string_view suffixes[] = {
        ".trip.csv", ".trip.csv.gz", ".trip.csv.zst", rawlog_suffix};
    return ends_with_one(name, suffixes);
}

bool is_archive_name(std::string_view name) {
    static constexpr std::string_view suffixes[] = {".zip", ".tar", ".tar.gz", ".tgz", ".tar.zst"};
    return ends_with_one(name, suffixes);
}

bool is_table_name(std::string_view name) {
    static constexpr std::string_view suffixes[] = {".csv", ".csv.gz", ".csv.zst", ".txt", ".vbo"};
    return ends_with_one(in_lower_case(name), suffixes);
}

std::pair<std::string, std::string> folder_and_file(const std::string& path) {
    const auto size = path.rfind('/') + 1; // 0 if there is none
    return {path.substr(0, size), path.substr(size)};
}

std::pair<std::string, std::string> place_in_export(const std::string& path) {
    auto [folder, file] = folder_and_file(path);
    if (belongs_to_export(file)) {
        return {std::move(folder), std::move(file)};
    }
    if (!folder.empty()) { // a subfolder of the export
        auto [above, inner] = folder_and_file(folder.substr(0, folder.size() - 1));
        auto inside = inner + "/" + file;
        if (belongs_to_export(inside)) {
            return {std::move(above), std::move(inside)};
        }
    }
    return {};
}

std::map<std::string, std::vector<std::string>> exports_in(const std::vector<std::string>& paths) {
    std::map<std::string, std::vector<std::string>> exports;
    for (const auto& path : paths) {
        if (auto [folder, file] = place_in_export(path); !file.empty()) {
            exports[folder].push_back(std::move(file));
        }
    }
    std::erase_if(exports, [](const auto& found) {
        return std::none_of(found.second.begin(), found.second.end(), marks_export);
    });
    for (auto& [folder, files] : exports) {
        std::sort(files.begin(), files.end());
    }
    return exports;
}

std::string companion(const std::string& file, const TripMapping& mapping, std::size_t table) {
    auto name = mapping.tables[table].file;
    if (const auto star = name.find('*'); star != std::string::npos) {
        name.replace(star, 1, star_of(file, mapping.tables.front().file));
    }
    return name;
}

} // namespace macadam
