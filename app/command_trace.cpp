#include "app/commands.hpp"
#include "app/estimation_options.hpp"
#include "app/mapping_option.hpp"
#include "app/pipeline.hpp"
#include "app/trip_place.hpp"
#include "app/vehicle_choice.hpp"

#include "estimator/common/error.hpp"
#include "storage/json.hpp"
#include "storage/trip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

constexpr double default_length_m = 20;
constexpr double z_of_90_percent = 1.645;

struct TraceOptions {
    std::filesystem::path trip;
    double length_m;
    bool json;
    PipelineConfig pipeline;
};

TraceOptions parse_trace(const Arguments& arguments) {
    TraceOptions options{.trip = arguments.operand("TRIP"),
                         .length_m = arguments.number("--length", default_length_m),
                         .json = arguments.flag("--json"),
                         .pipeline = pipeline_config_of(arguments)};
    if (!(options.length_m >= 1 && options.length_m <= 100000)) {
        throw UsageError{fmt::format("--length is {}, expected 1 to 100000 m", options.length_m)};
    }
    return options;
}

/// One row of the result; nothing: not known.
struct Row {
    double from_m;
    double to_m;
    double t_s;
    std::optional<GeoPoint> at;
    IriMean mean;
    std::optional<double> iri; ///< the headline: MRI where both tracks were observed, else HRI
};

Row row_of(double from_m,
           double length_m,
           const TripTrace& trace,
           const TripPlace& place,
           const Vehicle& vehicle) {
    const double middle_m = from_m + length_m / 2;
    Row row{.from_m = from_m,
            .to_m = from_m + length_m,
            .t_s = trace.odometer.t_s(middle_m),
            .at = {},
            .mean = mean_over(trace.roughness, from_m, from_m + length_m, vehicle),
            .iri = {}};
    row.at = place(row.t_s);
    row.iri = row.mean.mri_mm_per_m ? row.mean.mri_mm_per_m : row.mean.hri_mm_per_m;
    if (!row.iri) {
        row.mean.speed_mps = trace.odometer.speed_mps(row.t_s);
    }
    return row;
}

/// The columns, their values as JSON writes numbers, and their decimals.
std::vector<std::pair<std::string_view, JsonValue>> cells_of(const Row& row) {
    const auto& mean = row.mean;
    const auto known = [&](double value) { return row.iri ? std::optional{value} : std::nullopt; };
    const double iri = row.iri.value_or(0);
    return {
        {"from_m", JsonNumber{row.from_m, 3}},
        {"to_m", JsonNumber{row.to_m, 3}},
        {"t_s", json_number(row.t_s, 3)},
        {"lat_deg", json_number(row.at ? std::optional{row.at->lat_deg} : std::nullopt, 7)},
        {"lon_deg", json_number(row.at ? std::optional{row.at->lon_deg} : std::nullopt, 7)},
        {"speed_mps", json_number(mean.speed_mps, 3)},
        {"iri", json_number(row.iri, 3)},
        {"iri_sd", json_number(known(mean.sd_mm_per_m), 3)},
        {"iri_low", json_number(known(std::max(0.0, iri - z_of_90_percent * mean.sd_mm_per_m)), 3)},
        {"iri_high", json_number(known(iri + z_of_90_percent * mean.sd_mm_per_m), 3)},
        {"iri_left", json_number(mean.left_mm_per_m, 3)},
        {"iri_right", json_number(mean.right_mm_per_m, 3)},
        {"mri", json_number(mean.mri_mm_per_m, 3)},
        {"hri", json_number(mean.hri_mm_per_m, 3)},
        {"index",
         row.iri ? JsonValue{std::string{mean.mri_mm_per_m ? "MRI" : "HRI"}} : JsonValue{nullptr}},
        {"validity", name_of_validity(mean.validity)}};
}

std::string cell_text(const JsonValue& value) {
    if (const auto* const number = std::get_if<JsonNumber>(&value)) {
        return fmt::format("{:.{}f}", number->value, number->decimals);
    }
    const auto* const words = std::get_if<std::string>(&value);
    return words ? *words : std::string{};
}

std::string csv_of(const std::vector<Row>& rows) {
    std::string csv =
        "from_m,to_m,t_s,lat_deg,lon_deg,speed_mps,iri,iri_sd,iri_low,iri_high,iri_left,"
        "iri_right,mri,hri,index,validity\n";
    for (const auto& row : rows) {
        std::string_view before;
        for (const auto& [name, value] : cells_of(row)) {
            csv += before;
            csv += cell_text(value);
            before = ",";
        }
        csv += '\n';
    }
    return csv;
}

std::string json_of(const std::vector<Row>& rows) {
    std::vector<std::string> objects;
    for (const auto& row : rows) {
        JsonObject object;
        for (auto& [name, value] : cells_of(row)) {
            object.add(name, value);
        }
        objects.push_back(object.text());
    }
    return json_array(objects) + "\n";
}

void run_trace(const Arguments& arguments, const Console& console) {
    const auto options = parse_trace(arguments);
    VehicleChoice vehicles{arguments};
    std::vector<std::string> warnings;
    const auto source = one_trip(options.trip, mapping_of(arguments));
    const auto trip =
        with_latency(read_trip(source, needs_of_trace(), console.progress("reading")), warnings);
    const auto chosen = vehicles(options.trip, trip.meta.vehicle_id);
    const auto trace =
        naming(source.name(), [&] { return trace_of(trip, chosen.vehicle, options.pipeline); });

    if (!chosen.warning.empty()) {
        warnings.push_back(chosen.warning);
    }
    warnings.insert(warnings.end(), trace.warnings.begin(), trace.warnings.end());
    for (const auto& warning : warnings) {
        console.warn(warning);
    }
    const TripPlace place{trip};
    std::vector<Row> rows;
    const double whole_m = trace.odometer.whole_m();
    for (std::size_t i = 0; static_cast<double>(i + 1) * options.length_m <= whole_m; ++i) {
        rows.push_back(row_of(static_cast<double>(i) * options.length_m,
                              options.length_m,
                              trace,
                              place,
                              chosen.vehicle));
    }
    if (rows.empty()) {
        throw InputError{fmt::format("{}: goes {:.1f} m, expected at least --length {} m",
                                     options.trip.string(),
                                     whole_m,
                                     options.length_m)};
    }
    print(options.json ? json_of(rows) : csv_of(rows));
}

constexpr std::array operands{
    Operand{"TRIP", "One trip log (.trip.csv, .gz, .zst), or a phone's export (folder or .zip)."}};
constexpr std::array options{
    vehicle_option,
    vehicles_option,
    mapping_option,
    Option{"--length", "METRES", "Length of the reported pieces.", "20"},
    method_option,
    channels_option,
    no_filters_option,
    rate_option,
    Option{"--json", "", "An array of objects instead of CSV, with the same names."}};

} // namespace

const Command trace_command{
    .name = "trace",
    .summary = "IRI along one trip, without a map",
    .about =
        "One row for each 20 m of travel, with the place of its middle, the IRI in mm/m and its 90 "
        "% interval.\n"
        "index says which IRI the headline is: MRI where both wheel tracks were observed, HRI (of "
        "the mean\n"
        "profile) otherwise. Where nothing can be said iri is empty and validity says why: "
        "too_slow,\n"
        "start_up (the first 60 m of a stretch), gap. indicative: from lateral vibration alone.",
    .example = "  macadam trace drive.trip.csv.gz --vehicle my_car.toml > iri.csv\n"
               "  macadam trace drive.trip.csv --length 100 --json",
    .operands = operands,
    .options = options,
    .run = run_trace};

} // namespace macadam
