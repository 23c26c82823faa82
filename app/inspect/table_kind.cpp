#include "app/inspect/table_kind.hpp"

#include "storage/profiles/profile_reader.hpp"
#include "storage/settings/scenario_file.hpp"
#include "storage/settings/style_file.hpp"
#include "storage/settings/vehicle_file.hpp"
#include "storage/surveys/truth_file.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/tables/toml.hpp"
#include "storage/trips/mappings/column_mapping_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

using Use = FileKind::Use;

class Header {
public:
    explicit Header(std::string_view line) : names_{cells_of_line(line, ',')} {}

    bool has(std::string_view name) const {
        return std::ranges::find(names_, name) != names_.end();
    }
    bool has_any(std::initializer_list<std::string_view> names) const {
        return std::ranges::any_of(names, [&](std::string_view name) { return has(name); });
    }
    bool begins_with(std::string_view name) const { return names_.front() == name; }

private:
    std::vector<std::string> names_;
};

FileKind other(std::string_view name, std::string_view advice) {
    return {Use::other, std::string{name}, std::string{advice}};
}

} // namespace

std::optional<FileKind> kind_of_table(const TextSample& sample) {
    if (sample.lines.empty()) {
        return std::nullopt;
    }
    const Header header{sample.lines.front()};
    const bool has_iri = header.has_any({"iri", "mri", "hri", "iri_left", "iri_right"});
    if (header.begins_with("station_m")) {
        return other("road profile (CSV)", "macadam iri FILE");
    }
    if (sample.lines.front() == truth_header || sample.lines.front() == pothole_truth_header) {
        return other("truth of 'macadam simulate'", "macadam info STORE --truth FILE");
    }
    if (header.has("t_s") && header.has("validity")) {
        return other("result of 'macadam trace'", "it is an output; spreadsheets and GIS read it");
    }
    if (header.has("from_node") && header.has("to_node")) {
        return other("result of 'macadam match'", "it is an output; spreadsheets and GIS read it");
    }
    if (header.has("segment") && has_iri) {
        return other("segments exported by Macadam",
                     "it is an output; spreadsheets and GIS read it");
    }
    if (header.has("way_id") && header.has("name") && header.has("iri")) {
        return other("control sections", "macadam import STORE --control FILE");
    }
    if (has_iri && (header.has_any({"way_id", "begin_lat_deg"}) ||
                    (header.has("lat_deg") && header.has("lon_deg")))) {
        return other("reference survey",
                     "macadam import STORE --reference FILE, or macadam trace TRIP --against FILE");
    }
    if (header.has("name") && header.has_any({"route", "way_id", "road"})) {
        return other("list of sections", "macadam query STORE --sections FILE");
    }
    return std::nullopt;
}

FileKind kind_of_toml(const std::filesystem::path& file) {
    const auto table = read_toml(file, "settings");
    if (table.has("half_car") || table.has("axles")) {
        const auto vehicle = read_vehicle(file);
        return other(fmt::format("vehicle '{}'", vehicle.name),
                     "macadam import STORE TRIP --vehicle FILE");
    }
    if (table.has("channels") || table.has("time")) {
        read_mapping(file.string());
        return other("mapping of another logger", "macadam import STORE TRIP --mapping FILE");
    }
    if (table.has("car") || table.has("road") || table.has("fleet") || table.has("seed")) {
        read_recipe(file);
        return other("recipe of a simulated fleet", "macadam simulate -o DIR --recipe FILE");
    }
    read_style(file);
    return other("map style", "macadam render STORE --style FILE");
}

FileKind kind_of_profile(const std::filesystem::path& file) {
    const auto extent = extent_of_profile(file, std::nullopt);
    return other(fmt::format("road profile: {} to {} m, {} points, {}",
                             extent.first_m,
                             extent.last_m,
                             extent.points,
                             fmt::join(extent.tracks, ", ")),
                 "macadam iri FILE");
}

} // namespace macadam
