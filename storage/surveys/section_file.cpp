#include "storage/surveys/section_file.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/networks/osm_reader.hpp"
#include "storage/tables/csv_table.hpp"
#include "storage/tables/csv_values.hpp"
#include "storage/trips/positions/gpx_reader.hpp"
#include "storage/trips/trip_reader.hpp"
#include "storage/trips/trip_search.hpp"

#include <fmt/format.h>

#include <array>

namespace macadam {
namespace {

struct Unit {
    std::string_view from;
    std::string_view to;
    double in_m;
};
constexpr std::array units{Unit{"from_m", "to_m", 1},
                           Unit{"from_km", "to_km", 1000},
                           Unit{"from_mi", "to_mi", 1609.344}}; // the international mile
constexpr double longest = 1e9;

/// Unit of the columns with the measures; null: sections are whole roads.
const Unit* unit_of(const CsvTable& table) {
    const Unit* found = nullptr;
    for (const auto& unit : units) {
        if (table.has(unit.from) != table.has(unit.to)) {
            throw InputError{fmt::format("{}: the header has only {}, expected both {} and {}",
                                         table.where,
                                         table.has(unit.from) ? unit.from : unit.to,
                                         unit.from,
                                         unit.to)};
        }
        if (table.has(unit.from)) {
            if (found != nullptr) {
                throw InputError{fmt::format("{}: the header has both {} and {}, expected one unit",
                                             table.where,
                                             found->from,
                                             unit.from)};
            }
            found = &unit;
        }
    }
    if (found == nullptr && (table.has("from") || table.has("to"))) {
        throw InputError{fmt::format("{}: columns from and to have no unit, expected from_m "
                                     "and to_m, from_km and to_km, or from_mi and to_mi",
                                     table.where)};
    }
    return found;
}

/// Name such as "Main Street 1.2-3.4", with the numbers of the file.
std::string name_of(const CsvRow& row, const Unit* unit) {
    if (auto name = row.text("section"); !name.empty()) {
        return name;
    }
    const auto road = row.text("route").empty() ? row.text("way_id") : row.text("route");
    return unit == nullptr
               ? road
               : fmt::format("{} {}-{}", road, row.text(unit->from), row.text(unit->to));
}

SectionReference reference_in(const CsvRow& row, const Unit* unit) {
    SectionReference reference{.where = row.where(),
                               .name = name_of(row, unit),
                               .route = row.text("route"),
                               .way_id = row.whole("way_id"),
                               .forward = direction_in(row)};
    if (reference.route.empty() == !reference.way_id) {
        throw InputError{fmt::format("{}: has {} a route {} a way_id, expected one of them",
                                     row.where(),
                                     reference.way_id ? "both" : "neither",
                                     reference.way_id ? "and" : "nor")};
    }
    if (unit != nullptr) {
        const auto station_m = [&](std::string_view column) -> std::optional<double> {
            const auto value = row.number(column, 0, longest, "a station of 0 or more, or empty");
            return value ? std::optional{*value * unit->in_m} : std::nullopt;
        };
        reference.from_m = station_m(unit->from);
        reference.to_m = station_m(unit->to);
    }
    if (reference.from_m && reference.from_m == reference.to_m) {
        throw InputError{fmt::format(
            "{}: begins and ends at the same station, expected a length above 0", row.where())};
    }
    return reference;
}

std::vector<SectionReference> references_in_table(const std::filesystem::path& file) {
    const auto table = read_csv_table(file);
    if (!table.has("route") && !table.has("way_id")) {
        throw InputError{fmt::format("{}: the header has no column route or way_id, expected "
                                     "one that names the road",
                                     table.where)};
    }
    const auto* const unit = unit_of(table);
    std::vector<SectionReference> references;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        references.push_back(reference_in(table.row(i), unit));
    }
    return references;
}

std::vector<SectionReference> references_in_track(const std::filesystem::path& file) {
    SectionReference reference{.where = file.string(), .name = file.stem().string(), .route = ""};
    const auto found = first_trip(file, {.tracks = true});
    if (found.count != 1) {
        throw InputError{
            fmt::format("{}: contains {} tracks, expected one", file.string(), found.count)};
    }
    for (const auto& fix : read_trip(*found.trip, needs_of_match()).fixes) {
        reference.line.push_back(fix.at);
    }
    if (reference.line.size() < 2) {
        throw InputError{fmt::format("{}: the track has {} place{} with a time that can be read, "
                                     "expected at least 2",
                                     file.string(),
                                     reference.line.size(),
                                     reference.line.size() == 1 ? "" : "s")};
    }
    return {reference};
}

std::vector<SectionReference> references_in_layer(const std::filesystem::path& file) {
    const auto refuse = [](const std::string& words) {
        throw InputError{
            fmt::format("{}; sections are read completely or not at all: add points to it, or "
                        "remove it",
                        words)};
    };
    std::vector<SectionReference> references;
    for (auto& way : read_network(file, {}, {}, refuse)) {
        references.push_back({.where = file.string(),
                              .name = way.name.empty() ? fmt::format("{}", way.id) : way.name,
                              .route = "",
                              .line = std::move(way.line)});
    }
    return references;
}

} // namespace

std::vector<SectionReference> read_sections(const std::filesystem::path& file) {
    if (is_osm_file(file)) {
        throw InputError{fmt::format("{}: is a map, expected sections: a table (.csv), a GPX "
                                     "track or a layer of lines",
                                     file.string())};
    }
    auto references = file.extension() == ".csv"              ? references_in_table(file)
                      : is_gpx_name(file.filename().string()) ? references_in_track(file)
                                                              : references_in_layer(file);
    if (references.empty()) {
        throw InputError{fmt::format("{}: contains no section", file.string())};
    }
    return references;
}

} // namespace macadam
