#include "app/segment_output.hpp"

#include "app/printable.hpp"
#include "storage/export.hpp"
#include "storage/json.hpp"
#include "storage/utc.hpp"

#include <fmt/format.h>

#include <string_view>

namespace macadam {
namespace {

std::string table_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    std::string table = fmt::format("{:<18} {:<24} {:>17} {:>6} {:>13}  {:<6} {:>6} {:>5}  {}\n",
                                    "segment",
                                    "road",
                                    "from-to m",
                                    "IRI",
                                    "90 %",
                                    "class",
                                    "passes",
                                    "cars",
                                    "last seen");
    for (const auto& record : records) {
        const auto& segment = record.segment;
        const auto road = printable_name(record.name.empty() ? record.highway : record.name);
        table += fmt::format("{:<18} {:<24.24} {:>8.1f}-{:>8.1f}",
                             name_of(segment.key),
                             road,
                             segment.from_m,
                             segment.to_m);
        if (!record.state) {
            table += "      -             -  (nobody drove it yet)\n";
            continue;
        }
        const auto& state = *record.state;
        table += fmt::format(" {:>6.2f} {:>5.2f} - {:>5.2f}  {:<6} {:>6} {:>5}  {}\n",
                             state.iri_um / 1000.0,
                             state.low_um / 1000.0,
                             state.high_um / 1000.0,
                             classes.classes[class_index(classes, state.iri_um / 1000.0)].name,
                             state.passes,
                             state.vehicles,
                             state.last_seen_ms ? utc_text(*state.last_seen_ms).substr(0, 10)
                                                : "undated");
    }
    return table;
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

std::string json_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    std::vector<std::string> objects;
    objects.reserve(records.size());
    for (const auto& record : records) {
        objects.push_back(json_object_of(record, classes));
    }
    return json_array(objects) + "\n";
}

std::string csv_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    auto csv = csv_header() + "\n";
    for (const auto& record : records) {
        csv += csv_row(record, classes) + "\n";
    }
    return csv;
}

std::string geojson_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    std::vector<std::string> features;
    features.reserve(records.size());
    for (const auto& record : records) {
        features.push_back(geojson_feature(record, classes));
    }
    JsonObject collection;
    collection.add("type", std::string{"FeatureCollection"})
        .add("features", JsonRaw{json_array(features)});
    return collection.text() + "\n";
}

std::string lag_words(const PassRecord& record) {
    if (!record.lag_m) {
        return "-";
    }
    return record.finding == LagFinding::beyond_reach ? fmt::format(">{:g}", trace_margin_m)
                                                      : fmt::format("{:+.2f}", *record.lag_m);
}

std::string_view name_of(LagFinding finding) {
    switch (finding) {
    case LagFinding::alone:
        break;
    case LagFinding::found:
        return "found";
    case LagFinding::beyond_reach:
        return "beyond_reach";
    }
    return "alone";
}

std::string history_table(const std::vector<PassRecord>& passes) {
    auto table = fmt::format("{:<22} {:<16} {:>6} {:>6} {:>6} {:>7} {:>10}  {}\n",
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
        table += fmt::format("{:<22} {:<16} {:>6.2f} {:>6.2f} {:>6} {:>7.1f} {:>10.2f}  {:.12}\n",
                             record.utc_ms ? utc_text(*record.utc_ms / 1000 * 1000) : "undated",
                             record.vehicle,
                             pass.iri_um / 1000.0,
                             pass.sd_um / 1000.0,
                             lag_words(record),
                             pass.speed_mmps * 3.6e-3,
                             pass.confidence_ppm / 1e6,
                             record.trip_sha256);
    }
    return table;
}

std::string history_json(const std::vector<PassRecord>& passes) {
    const auto um = [](std::optional<IriUm> iri_um) {
        return iri_um ? json_number(*iri_um / 1000.0, 3) : JsonValue{nullptr};
    };
    std::vector<std::string> objects;
    for (const auto& record : passes) {
        const auto& pass = record.pass;
        JsonObject object;
        object.add("segment", name_of(pass.segment))
            .add("utc", record.utc_ms ? JsonValue{utc_text(*record.utc_ms)} : JsonValue{nullptr})
            .add("vehicle", record.vehicle)
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

} // namespace

std::string segments_text(const std::vector<SegmentRecord>& records,
                          const ClassTable& classes,
                          std::string_view format) {
    if (format == "json") {
        return json_of(records, classes);
    }
    if (format == "csv") {
        return csv_of(records, classes);
    }
    return format == "geojson" ? geojson_of(records, classes) : table_of(records, classes);
}

std::string history_text(const std::vector<PassRecord>& passes, std::string_view format) {
    return format == "json" ? history_json(passes) : history_table(passes);
}

} // namespace macadam
