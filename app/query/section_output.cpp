#include "app/query/section_output.hpp"

#include "app/cli/terminal_escape.hpp"
#include "storage/exports/export.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr int place_decimals = 7; // 1 cm

bool is_measured(const NamedSection& section) {
    return section.section.measured.mean.length_m > 0;
}

std::string_view class_of(const NamedSection& section, const ClassTable& classes) {
    return classes.classes[class_index(classes, section.section.measured.mean.iri)].name;
}

std::string day_cell(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? utc_day(*utc_ms) : "";
}

// --------------------------------------------------------------------------------------- table

std::string table_head() {
    return fmt::format("{:<30} {:>9} {:>9} {:>7} {:>7} {:>6} {:>13}  {:<6} {:>6} {:>4}  {}\n",
                       "section",
                       "from m",
                       "to m",
                       "metres",
                       "covered",
                       "IRI",
                       "90 %",
                       "class",
                       "passes",
                       "cars",
                       "last seen");
}

std::string table_row(const NamedSection& named, const ClassTable& classes) {
    const auto& [from_m, to_m, excluded_m, open_share, measured, parts, line] = named.section;
    const auto row = fmt::format("{:<30.30} {:>9.1f} {:>9.1f} {:>7.0f} {:>5.0f} %",
                                 printable_name(named.name),
                                 named.from_m,
                                 named.to_m,
                                 to_m - from_m,
                                 100 * open_share);
    if (!is_measured(named)) {
        return row + "      -             -\n";
    }
    const auto passes = measured.min_passes == measured.median_passes
                            ? fmt::format("{}", measured.min_passes)
                            : fmt::format("{}-{:g}", measured.min_passes, measured.median_passes);
    return row + fmt::format(" {:>6.2f} {:>5.2f} - {:>5.2f}  {:<6} {:>6} {:>4}  {}\n",
                             measured.mean.iri,
                             measured.mean.low,
                             measured.mean.high,
                             class_of(named, classes),
                             passes,
                             measured.vehicles,
                             measured.last_seen_ms ? utc_day(*measured.last_seen_ms) : "undated");
}

// --------------------------------------------------------------------------------- CSV and JSON

/// Field of all formats, in their common order and with the same number format.
using Value = std::pair<std::string_view, JsonValue>;

JsonValue known(bool is_known, double value) {
    return is_known ? JsonValue{JsonNumber{value, 3}} : JsonValue{nullptr};
}

JsonValue text_or_null(std::string text) {
    return text.empty() ? JsonValue{nullptr} : JsonValue{std::move(text)};
}

std::vector<Value> values_of(const NamedSection& named, const ClassTable& classes) {
    const auto& section = named.section;
    const auto& [mean, worst_iri, min_passes, median_passes, vehicles, first_ms, last_ms] =
        section.measured;
    const bool measured = is_measured(named);
    return {{"section", named.name},
            {"from_m", JsonNumber{named.from_m, 2}},
            {"to_m", JsonNumber{named.to_m, 2}},
            {"length_m", JsonNumber{section.to_m - section.from_m, 2}},
            {"measured_m", JsonNumber{mean.length_m, 2}},
            {"excluded_m", JsonNumber{section.excluded_m, 2}},
            {"covered", JsonNumber{section.open_share, 4}},
            {"iri", known(measured, mean.iri)},
            {"iri_sd", known(measured, mean.sd)},
            {"iri_low", known(measured, mean.low)},
            {"iri_high", known(measured, mean.high)},
            {"iri_worst", known(measured, worst_iri)},
            {"class", text_or_null(measured ? std::string{class_of(named, classes)} : "")},
            {"passes_least", std::int64_t{min_passes}},
            {"passes_median", JsonRaw{fmt::format("{}", median_passes)}},
            {"vehicles", std::int64_t{vehicles}},
            {"first_seen", text_or_null(day_cell(first_ms))},
            {"last_seen", text_or_null(day_cell(last_ms))}};
}

std::string cell_of(const JsonValue& value) {
    struct Cell {
        std::string operator()(std::nullptr_t) const { return ""; }
        std::string operator()(bool yes) const { return yes ? "true" : "false"; }
        std::string operator()(std::int64_t whole) const { return fmt::format("{}", whole); }
        std::string operator()(const JsonNumber& number) const {
            return fmt::format("{:.{}f}", number.value, number.decimals);
        }
        std::string operator()(const std::string& text) const { return csv_text(text); }
        std::string operator()(const JsonRaw& raw) const { return raw.text; }
    };
    return std::visit(Cell{}, value);
}

/// Lists of the parts on ways, with one value for each part, separated by semicolons.
struct PartLists {
    std::vector<std::int64_t> way_ids;
    std::vector<std::string_view> directions;
    std::vector<std::string> from_m;
    std::vector<std::string> to_m;
};

PartLists lists_of(const RoadSection& section) {
    PartLists lists;
    for (const auto& part : section.parts) {
        lists.way_ids.push_back(part.way_id);
        lists.directions.push_back(part.forward ? "forward" : "backward");
        lists.from_m.push_back(fmt::format("{:.2f}", part.from_m));
        lists.to_m.push_back(fmt::format("{:.2f}", part.to_m));
    }
    return lists;
}

constexpr std::string_view csv_head =
    "section,from_m,to_m,length_m,measured_m,excluded_m,covered,iri,iri_sd,iri_low,iri_high,"
    "iri_worst,class,passes_least,passes_median,vehicles,first_seen,last_seen,way_ids,directions,"
    "way_from_m,way_to_m,lat_deg,lon_deg\n";

std::string csv_row(const NamedSection& named, const ClassTable& classes) {
    std::string row;
    for (const auto& [name, value] : values_of(named, classes)) {
        row += cell_of(value) + ",";
    }
    const auto lists = lists_of(named.section);
    row += fmt::format("{},{},{},{},",
                       fmt::join(lists.way_ids, ";"),
                       fmt::join(lists.directions, ";"),
                       fmt::join(lists.from_m, ";"),
                       fmt::join(lists.to_m, ";"));
    if (named.section.line.empty()) {
        return row + ",\n";
    }
    const auto middle = halfway_along(named.section.line);
    return row +
           fmt::format(
               "{:.{}f},{:.{}f}\n", middle.lat_deg, place_decimals, middle.lon_deg, place_decimals);
}

std::string json_object_of(const NamedSection& named, const ClassTable& classes) {
    JsonObject object;
    for (auto& [name, value] : values_of(named, classes)) {
        object.add(name, std::move(value));
    }
    std::vector<std::string> parts;
    for (const auto& part : named.section.parts) {
        JsonObject entry;
        entry.add("way_id", part.way_id)
            .add("direction", std::string{part.forward ? "forward" : "backward"})
            .add("from_m", JsonNumber{part.from_m, 2})
            .add("to_m", JsonNumber{part.to_m, 2});
        parts.push_back(entry.text());
    }
    object.add("parts", JsonRaw{json_array(parts)});
    return object.text();
}

std::string geojson_feature(const NamedSection& named, const ClassTable& classes) {
    JsonObject feature;
    feature.add("type", "Feature")
        .add("geometry",
             named.section.line.empty() ? JsonValue{nullptr}
                                        : JsonValue{JsonRaw{geojson_geometry(named.section.line)}})
        .add("properties", JsonRaw{json_object_of(named, classes)});
    return feature.text();
}

/// Text before the first section, between two, and after the last.
struct Frame {
    std::string head;
    std::string_view separator;
    std::string_view tail;
};

Frame frame_of(std::string_view format) {
    if (format == "json") {
        return {"[", ",", "]\n"};
    }
    if (format == "csv") {
        return {std::string{csv_head}, "", ""};
    }
    return format == "geojson" ? Frame{R"({"type":"FeatureCollection","features":[)", ",\n", "]}\n"}
                               : Frame{table_head(), "", ""};
}

std::string
text_of(const NamedSection& section, const ClassTable& classes, std::string_view format) {
    if (format == "json") {
        return json_object_of(section, classes);
    }
    if (format == "csv") {
        return csv_row(section, classes);
    }
    return format == "geojson" ? geojson_feature(section, classes) : table_row(section, classes);
}

} // namespace

SectionWriter::SectionWriter(std::string_view format, const ClassTable& classes, Put put)
    : format_{format}, classes_{&classes}, put_{std::move(put)} {}

void SectionWriter::add(const NamedSection& section) {
    const auto frame = frame_of(format_);
    put_(count_++ == 0 ? frame.head : frame.separator);
    put_(text_of(section, *classes_, format_));
}

void SectionWriter::finish() {
    const auto frame = frame_of(format_);
    if (count_ == 0) {
        put_(frame.head);
    }
    put_(frame.tail);
}

std::string spoken(const SectionTotal& total) {
    auto words = fmt::format(
        "{:.2f} km, of which {:.2f} km measured", total.length_m / 1000, total.measured_m / 1000);
    if (total.excluded_m > 0) {
        words += fmt::format(", {:.2f} km excluded", total.excluded_m / 1000);
    }
    return words;
}

} // namespace macadam
