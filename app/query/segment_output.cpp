#include "app/query/segment_output.hpp"

#include "app/cli/console.hpp"
#include "app/cli/terminal_escape.hpp"
#include "storage/exports/export.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <string_view>

namespace macadam {
namespace {

std::string table_head() {
    return fmt::format("{:<18} {:<24} {:>17} {:>6} {:>13}  {:<6} {:>6} {:>5}  {}\n",
                       "segment",
                       "road",
                       "from-to m",
                       "IRI",
                       "90 %",
                       "class",
                       "passes",
                       "cars",
                       "last seen");
}

std::string table_row(const SegmentRecord& record, const ClassTable& classes) {
    const auto& segment = record.segment;
    const auto row = fmt::format("{:<18} {:<24.24} {:>8.1f}-{:>8.1f}",
                                 name_of(segment.key),
                                 printable_name(record.name.empty() ? record.highway : record.name),
                                 segment.from_m,
                                 segment.to_m);
    if (!record.state) {
        return row + "      -             -  (no pass)\n";
    }
    const auto& state = *record.state;
    return row + fmt::format(" {:>6.2f} {:>5.2f} - {:>5.2f}  {:<6} {:>6} {:>5}  {}\n",
                             state.iri_um / 1000.0,
                             state.low_um / 1000.0,
                             state.high_um / 1000.0,
                             classes.classes[class_index(classes, state.iri_um / 1000.0)].name,
                             state.passes,
                             state.vehicles,
                             state.last_seen_ms ? utc_day(*state.last_seen_ms) : "undated");
}

std::string json_object_of(const SegmentRecord& record, const ClassTable& classes) {
    JsonObject object;
    const auto values = field_values(record, classes);
    const auto fields = segment_fields();
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (!values[i]) {
            object.add(fields[i].name, nullptr);
        } else if (fields[i].type == Field::Type::text) {
            object.add(fields[i].name, *values[i]);
        } else {
            object.add(fields[i].name, JsonRaw{*values[i]});
        }
    }
    return object.text();
}

std::string lag_words(const HistoricPass& record) {
    if (!record.lag_m) {
        return "-";
    }
    return record.finding == LagStatus::beyond_reach ? fmt::format(">{:g}", trace_margin_m)
                                                     : fmt::format("{:+.2f}", *record.lag_m);
}

std::string_view name_of(LagStatus finding) {
    switch (finding) {
    case LagStatus::alone:
        break;
    case LagStatus::found:
        return "found";
    case LagStatus::beyond_reach:
        return "beyond_reach";
    }
    return "alone";
}

std::string passes_table(const std::vector<HistoricPass>& passes) {
    auto table = fmt::format("{:<22} {:<34} {:>6} {:>6} {:>6} {:>7} {:>10}  {}\n",
                             "when",
                             "vehicle",
                             "IRI",
                             "sd",
                             "lag m",
                             "km/h",
                             "confidence",
                             "trip");
    for (const auto& record : passes) {
        const auto& pass = record.pass;
        table += fmt::format("{:<22} {:<16} {:>6.2f} {:>6.2f} {:>6} {:>7.1f} {:>10.2f}  {}\n",
                             record.utc_ms ? utc_text(*record.utc_ms / 1000 * 1000) : "undated",
                             record.reference ? "reference" : record.vehicle,
                             pass.iri_um / 1000.0,
                             pass.sd_um / 1000.0,
                             lag_words(record),
                             pass.speed_mmps * 3.6e-3,
                             pass.confidence_ppm / 1e6,
                             record.reference ? printable_name(*record.reference)
                                              : record.trip_sha256.substr(0, 12));
    }
    return table;
}

std::string passes_json(const std::vector<HistoricPass>& passes) {
    const auto um = [](std::optional<IriUm> iri_um) {
        return iri_um ? json_number(*iri_um / 1000.0, 3) : JsonValue{nullptr};
    };
    std::vector<std::string> objects;
    for (const auto& record : passes) {
        const auto& pass = record.pass;
        JsonObject object;
        object.add("segment", name_of(pass.segment))
            .add("utc", record.utc_ms ? JsonValue{utc_text(*record.utc_ms)} : JsonValue{nullptr})
            .add("vehicle", record.reference ? JsonValue{nullptr} : JsonValue{record.vehicle})
            .add("reference", record.reference ? JsonValue{*record.reference} : JsonValue{nullptr})
            .add("iri", um(pass.iri_um))
            .add("iri_sd", um(pass.sd_um))
            .add("iri_left", um(pass.iri_left_um))
            .add("iri_right", um(pass.iri_right_um))
            .add("hri", um(pass.iri_centre_um))
            .add("speed_mps", JsonNumber{pass.speed_mmps / 1000.0, 3})
            .add("covered_m", JsonNumber{pass.covered_mm / 1000.0, 3})
            .add("lag_m", record.lag_m ? json_number(*record.lag_m, 2) : JsonValue{nullptr})
            .add("lag_finding",
                 record.lag_m ? JsonValue{std::string{name_of(record.finding)}}
                              : JsonValue{nullptr})
            .add("confidence", JsonNumber{pass.confidence_ppm / 1e6, 3})
            .add("validity", name_of_validity(pass.validity))
            .add("trip", record.trip_sha256);
        objects.push_back(object.text());
    }
    return json_array(objects) + "\n";
}

std::string passes_csv(const std::vector<HistoricPass>& passes) {
    const auto um = [](std::optional<IriUm> iri_um) {
        return iri_um ? fmt::format("{:.3f}", *iri_um / 1000.0) : "";
    };
    std::string csv{"segment,utc,vehicle,iri,iri_sd,iri_left,iri_right,hri,speed_mps,covered_m,"
                    "lag_m,lag_finding,confidence,validity,trip,reference\n"};
    for (const auto& record : passes) {
        const auto& pass = record.pass;
        csv += fmt::format("{},{},{},{},{},{},{},{},{:.3f},{:.3f},{},{},{:.3f},{},{},{}\n",
                           csv_text(name_of(pass.segment)),
                           record.utc_ms ? utc_text(*record.utc_ms) : "",
                           csv_text(record.vehicle),
                           um(pass.iri_um),
                           um(pass.sd_um),
                           um(pass.iri_left_um),
                           um(pass.iri_right_um),
                           um(pass.iri_centre_um),
                           pass.speed_mmps / 1000.0,
                           pass.covered_mm / 1000.0,
                           record.lag_m ? fmt::format("{:.2f}", *record.lag_m) : "",
                           record.lag_m ? name_of(record.finding) : "",
                           pass.confidence_ppm / 1e6,
                           name_of_validity(pass.validity),
                           record.trip_sha256,
                           csv_text(record.reference.value_or("")));
    }
    return csv;
}

/// Text before the first segment, between two, and after the last.
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
        return {csv_header() + "\n", "", ""};
    }
    return format == "geojson" ? Frame{R"({"type":"FeatureCollection","features":[)", ",", "]}\n"}
                               : Frame{table_head(), "", ""};
}

std::string
text_of(const SegmentRecord& record, const ClassTable& classes, std::string_view format) {
    if (format == "json") {
        return json_object_of(record, classes);
    }
    if (format == "csv") {
        return csv_row(record, classes) + "\n";
    }
    return format == "geojson" ? geojson_feature(record, classes) : table_row(record, classes);
}

} // namespace

SegmentPrinter::SegmentPrinter(std::string_view format, const ClassTable& classes)
    : format_{format}, classes_{&classes} {}

void SegmentPrinter::add(const SegmentRecord& record) {
    const auto frame = frame_of(format_);
    print_in(format_, count_++ == 0 ? frame.head : frame.separator);
    print_in(format_, text_of(record, *classes_, format_));
}

void SegmentPrinter::finish() {
    const auto frame = frame_of(format_);
    if (count_ == 0 && format_ != "table") {
        print_in(format_, frame.head);
    }
    print_in(format_, frame.tail);
}

std::string passes_text(const std::vector<HistoricPass>& passes, std::string_view format) {
    return format == "json"  ? passes_json(passes)
           : format == "csv" ? passes_csv(passes)
                             : passes_table(passes);
}

void print_in(std::string_view format, std::string_view text) {
    if (format == "table") {
        print_words(text);
    } else {
        print(text);
    }
}

} // namespace macadam
