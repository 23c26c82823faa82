#include "app/query/section_output.hpp"

#include "app/query/mean_cells.hpp"
#include "storage/exports/export.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {
namespace {

using Row = ClassedSection;

bool is_measured(const Row& row) {
    return row.named.section.measured.mean.length_m > 0;
}

Cell of_mean(const Row& row, double RoadMean::*value) {
    return known_if(is_measured(row), row.named.section.measured.mean.*value);
}

Cell class_of(const Row& row) {
    if (!is_measured(row)) {
        return {};
    }
    const double iri = row.named.section.measured.mean.iri;
    return row.classes.classes[class_index(row.classes, iri)].name;
}

/// Value in a table, which shows nothing after the interval of a section without a pass.
std::string in_table(const Row& row, const std::string& text) {
    return is_measured(row) ? text : "";
}

std::string last_seen_words(const Row& row) {
    const auto& last_ms = row.named.section.measured.last_seen_ms;
    return in_table(row, last_ms ? utc_day(*last_ms) : "undated");
}

Cell middle_of(const Row& row, double GeoPoint::*value) {
    const auto& line = row.named.section.line;
    return line.empty() ? Cell{} : Cell{halfway_along(line).*value};
}

const RoadSection& section(const Row& row) {
    return row.named.section;
}

const CorrelatedMean& measured(const Row& row) {
    return row.named.section.measured;
}

// clang-format off
const Columns<Row> columns{
    {"section", as::text, [](auto& r) { return r.named.name; }, {"section", "{:<30.30}"}},
    {"from_m", as::metres(2), [](auto& r) { return r.named.from_m; }, {"from m", " {:>9}", 1}},
    {"to_m", as::metres(2), [](auto& r) { return r.named.to_m; }, {"to m", " {:>9}", 1}},
    {"length_m", as::metres(2), [](auto& r) { return section(r).to_m - section(r).from_m; },
     {"metres", " {:>7}", 0}},
    {"measured_m", as::metres(2), [](auto& r) { return measured(r).mean.length_m; }},
    {"excluded_m", as::metres(2), [](auto& r) { return section(r).excluded_m; }},
    {"covered", as::real(4), [](auto& r) { return section(r).open_share; }},
    {"", as::text, [](auto& r) { return fmt::format("{:.0f} %", 100 * section(r).open_share); },
     {"covered", " {:>7}"}},
    {"iri", as::iri(3), [](auto& r) { return of_mean(r, &RoadMean::iri); }, {"IRI", " {:>6}", 2}},
    {"", as::numbers_in("mm/m"), [](auto& r) { return known_if(is_measured(r), interval_text(measured(r).mean)); },
     {"90 %", " {:>13}"}},
    {"iri_sd", as::iri(3), [](auto& r) { return of_mean(r, &RoadMean::sd); }},
    {"iri_low", as::iri(3), [](auto& r) { return of_mean(r, &RoadMean::low); }},
    {"iri_high", as::iri(3), [](auto& r) { return of_mean(r, &RoadMean::high); }},
    {"iri_worst", as::iri(3), [](auto& r) { return known_if(is_measured(r), measured(r).worst_iri); }},
    {"class", as::text, class_of},
    {"", as::text, [](auto& r) { return is_measured(r) ? class_of(r) : Cell{""}; },
     {"class", "  {:<6}"}},
    {"passes_least", as::integer, [](auto& r) { return measured(r).min_passes; }},
    {"passes_median", as::shortest, [](auto& r) { return measured(r).median_passes; }},
    {"", as::text, [](auto& r) {
         return in_table(r, passes_cell(measured(r).min_passes, measured(r).median_passes)); },
     {"passes", " {:>6}"}},
    {"vehicles", as::integer, [](auto& r) { return measured(r).vehicles; }},
    {"", as::text, [](auto& r) { return in_table(r, fmt::format("{}", measured(r).vehicles)); },
     {"cars", " {:>4}"}},
    {"first_seen", as::day, [](auto& r) { return day_cell(measured(r).first_seen_ms); }},
    {"last_seen", as::day, [](auto& r) { return day_cell(measured(r).last_seen_ms); }},
    {"", as::text, last_seen_words, {"last seen", "  {}"}},
    {"parts", as::json_only(as::numbers_in("m", as::raw)), [](auto& r) { return parts_json(section(r).parts); }},
    {"way_ids", as::csv_only(as::raw), [](auto& r) { return way_ids_list(section(r).parts); }},
    {"directions", as::csv_only(as::raw), [](auto& r) { return directions_list(section(r).parts); }},
    {"way_from_m", as::csv_only(as::numbers_in("m", as::raw)),
     [](auto& r) { return metres_list(section(r).parts, &StretchPart::from_m); }},
    {"way_to_m", as::csv_only(as::numbers_in("m", as::raw)),
     [](auto& r) { return metres_list(section(r).parts, &StretchPart::to_m); }},
    {"lat_deg", as::csv_only(as::degrees), [](auto& r) { return middle_of(r, &GeoPoint::lat_deg); }},
    {"lon_deg", as::csv_only(as::degrees), [](auto& r) { return middle_of(r, &GeoPoint::lon_deg); }},
};
// clang-format on

} // namespace

const Columns<ClassedSection>& section_columns() {
    return columns;
}

SectionWriter
section_writer(std::string_view format, RowWriter<ClassedSection>::Put put, UnitSystem units) {
    auto in_unit = std::make_shared<const Columns<Row>>(in_units(columns, units));
    RowWriter<Row> writer{format, *in_unit, std::move(put), [in_unit](const Row& row) {
                              return geojson_feature(
                                  {}, row.named.section.line, json_object(*in_unit, row));
                          }};
    writer.feature_separator = ",\n";
    return {std::move(in_unit), std::move(writer)};
}

std::string spoken(const SectionTotal& total, UnitSystem units) {
    const auto length = [&](double length_m) { return km_words(length_m / 1000, 2, units); };
    auto words =
        fmt::format("{}, of which {} measured", length(total.length_m), length(total.measured_m));
    if (total.excluded_m > 0) {
        words += fmt::format(", {} excluded", length(total.excluded_m));
    }
    return words;
}

} // namespace macadam
