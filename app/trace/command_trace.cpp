#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/row_writer.hpp"
#include "app/output/units_option.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/estimation_options.hpp"
#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/single_trip.hpp"
#include "app/pipeline/trip_preparation.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "app/trace/survey_check.hpp"
#include "app/trace/survey_check_output.hpp"
#include "app/trace/trace_events.hpp"
#include "app/trace/trace_live.hpp"
#include "app/trace/trace_profile.hpp"
#include "app/trace/trace_rows.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/surveys/survey_reader.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr double default_length_m = 20;
constexpr const char* from_standard_input = "-";

struct TraceOptions {
    std::filesystem::path trip;
    double length_m;
    bool json;
    UnitSystem units;                             ///< of the rows
    std::optional<std::filesystem::path> profile; ///< file to write
    std::optional<std::filesystem::path> events;  ///< file to write
    std::optional<std::filesystem::path> survey;  ///< reference for the trip
    std::optional<std::filesystem::path> figure;  ///< chart of both, to write
    std::optional<std::filesystem::path> output;  ///< rows, instead of standard output
    double mm_per_m_of_one;                       ///< mm/m of a survey IRI of 1
    SurveyMatchConfig match;
    PipelineConfig pipeline;
};

std::optional<std::filesystem::path> profile_file(const Arguments& arguments) {
    const auto file = arguments.value("--profile");
    if (file && std::filesystem::path{*file}.extension() != ".erd") {
        throw UsageError{
            fmt::format("--profile is '{}', expected a name that ends in .erd", *file)};
    }
    return file;
}

std::optional<std::filesystem::path> events_file(const Arguments& arguments) {
    const auto file = arguments.value("--events");
    constexpr std::array<std::string_view, 3> suffixes{".csv", ".json", ".geojson"};
    if (file && std::ranges::find(suffixes, std::filesystem::path{*file}.extension().string()) ==
                    suffixes.end()) {
        throw UsageError{fmt::format(
            "--events is '{}', expected a name that ends in {}", *file, fmt::join(suffixes, ", "))};
    }
    return file;
}

std::optional<std::filesystem::path> output_file(const Arguments& arguments) {
    const auto file = arguments.value("--output");
    if (file == standard_output) {
        return std::nullopt;
    }
    constexpr std::array<std::string_view, 3> suffixes{".csv", ".json", ".svg"};
    if (file && std::ranges::find(suffixes, std::filesystem::path{*file}.extension().string()) ==
                    suffixes.end()) {
        throw UsageError{fmt::format(
            "-o is '{}', expected a name that ends in {}", *file, fmt::join(suffixes, ", "))};
    }
    return file;
}

double number_within(
    const Arguments& arguments, std::string_view name, double fallback, double least, double most) {
    const double value = arguments.number(name, fallback);
    if (!(value >= least && value <= most)) {
        throw UsageError{fmt::format("{} is {}, expected {} to {}", name, value, least, most)};
    }
    return value;
}

/// Parses the options of --against and rejects them without it.
TraceOptions with_survey(TraceOptions options, const Arguments& arguments) {
    options.survey = arguments.value("--against");
    for (const auto* const option : {"--max-distance", "--max-angle", "--unit"}) {
        if (!options.survey && arguments.value(option)) {
            throw UsageError{fmt::format("{} requires --against SURVEY.csv", option)};
        }
    }
    if (options.survey && arguments.value("--length")) {
        throw UsageError{"--length and --against cannot be combined: the survey sets the "
                         "lengths"};
    }
    if (options.output && options.output->extension() == ".svg") {
        if (!options.survey) {
            throw UsageError{"-o FILE.svg requires --against SURVEY.csv"};
        }
        options.figure = std::exchange(options.output, std::nullopt);
    }
    auto& match = options.match;
    match.max_distance_m =
        number_within(arguments, "--max-distance", match.max_distance_m, 0.5, 100);
    match.max_angle_deg = number_within(arguments, "--max-angle", match.max_angle_deg, 1, 180);
    options.mm_per_m_of_one = arguments.choice("--unit") == "in/mi" ? 1 / in_per_mi_of_mm_per_m : 1;
    return options;
}

TraceOptions parse_trace(const Arguments& arguments) {
    TraceOptions options{.trip = arguments.operand("TRIP"),
                         .length_m = arguments.number("--length", default_length_m),
                         .json = row_format_of(arguments) == "json",
                         .units = parse_units(arguments),
                         .profile = profile_file(arguments),
                         .events = events_file(arguments),
                         .survey = {},
                         .figure = {},
                         .output = output_file(arguments),
                         .mm_per_m_of_one = 1,
                         .match = {},
                         .pipeline = pipeline_config_of(arguments)};
    if (options.events && options.pipeline.estimator.method == Method::kf) {
        throw UsageError{"--events requires --method smoother"};
    }
    options.pipeline.estimator.profile = options.profile || options.events;
    if (!(options.length_m >= 1 && options.length_m <= 100000)) {
        throw UsageError{fmt::format("--length is {}, expected 1 to 100000 m", options.length_m)};
    }
    return with_survey(std::move(options), arguments);
}

void write_profile_of(const TripTrace& trace,
                      const Vehicle& vehicle,
                      const TraceOptions& options,
                      const Console& console) {
    const auto method = options.pipeline.estimator.method;
    for (const auto& [file, from_m, to_m, tracks] :
         write_profiles(*options.profile, trace, vehicle, method)) {
        console.say(fmt::format("{}: {} from {:.2f} to {:.2f} m of travel",
                                file.string(),
                                tracks ? "left and right track" : "mean of both tracks",
                                from_m,
                                to_m));
    }
}

void print_against(const std::vector<SurveyRow>& survey,
                   const TripLog& trip,
                   const TripTrace& trace,
                   const Vehicle& vehicle,
                   const TraceOptions& options,
                   const Console& console) {
    const auto against = with_trip_name(options.trip.string(), [&] {
        return against_survey(survey, trip, trace, vehicle, options.match);
    });
    if (options.figure) {
        AtomicFile out{*options.figure};
        out.write(against_svg(against));
        out.commit();
    }
    auto summary = against_summary(against);
    summary.pop_back();
    console.say(summary);
    print(options.json ? against_json(against) : against_csv(against));
}

/// Prints row by row: the rows of a long trip take more memory than the trip.
void print_rows(const TripLog& trip,
                const TripTrace& trace,
                const Vehicle& vehicle,
                const TraceOptions& options) {
    if (const double whole_m = trace.odometer.whole_m(); whole_m < options.length_m) {
        throw InputError{fmt::format("{}: is {:.1f} m long, expected at least --length {} m",
                                     options.trip.string(),
                                     whole_m,
                                     options.length_m)};
    }
    const auto columns = in_units(trace_columns(), options.units);
    RowWriter<TraceRow> writer{
        options.json ? "json" : "csv", columns, [](std::string_view text) { print(text); }};
    each_trace_row(trace, options.length_m, TripPositions{trip}, vehicle, [&](const TraceRow& row) {
        writer.add(row);
    });
    writer.finish();
}

/// Rejects options that need the whole trip or another reader.
void expect_live(const Arguments& arguments) {
    for (const auto* const option : {"--mapping",
                                     "--positions",
                                     "--profile",
                                     "--events",
                                     "--against",
                                     "--output",
                                     "--units"}) {
        if (arguments.value(option)) {
            throw UsageError{fmt::format("--live and {} cannot be combined", option)};
        }
    }
}

/// Expects that no output is an input, or another output.
void expect_separate_outputs(const TraceOptions& options) {
    std::vector<std::filesystem::path> outputs;
    for (const auto& output : {options.profile, options.events, options.figure, options.output}) {
        if (!output) {
            continue;
        }
        refuse_to_replace(*output, {options.trip, options.survey.value_or(options.trip)});
        const auto path = std::filesystem::absolute(*output).lexically_normal();
        if (std::ranges::find(outputs, path) != outputs.end()) {
            throw UsageError{fmt::format("{} is given for two outputs, expected a file for each",
                                         std::filesystem::path{*output}.string())};
        }
        outputs.push_back(path);
    }
}

void run_trace(const Arguments& arguments, const Console& console) {
    const auto options = parse_trace(arguments);
    if (arguments.flag("--live")) {
        expect_live(arguments);
        trace_live(
            options.trip, options.pipeline, options.length_m, options.json, arguments, console);
        return;
    }
    if (options.trip == from_standard_input) {
        throw UsageError{"TRIP is missing; only --live reads standard input"};
    }
    VehicleChoice vehicles{arguments};
    expect_separate_outputs(options);
    const auto survey = options.survey ? read_survey(*options.survey, options.mm_per_m_of_one)
                                       : std::vector<SurveyRow>{};
    const auto source =
        one_trip(options.trip, mapping_of(arguments), arguments.value("--positions").value_or(""));
    auto log = read_trip(source, needs_of_trace(), console.progress("reading"));
    with_trip_name(source.name(), [&] { vehicles.name_car(log.meta); });
    const auto chosen = vehicles(options.trip, log.meta);
    auto found = with_trip_name(
        source.name(), [&] { return prepared(std::move(log), options.pipeline.odometer); });
    const auto& trip = found.trip;
    const auto trace = with_trip_name(source.name(), [&] {
        return trace_of(trip,
                        std::move(found.motion),
                        chosen.vehicle,
                        options.pipeline,
                        {.report = {}, .stop = console.stop()});
    });
    auto warnings = std::move(found.warnings);

    if (!chosen.warning.empty()) {
        warnings.push_back(chosen.warning);
    }
    warnings.insert(warnings.end(), trace.warnings.begin(), trace.warnings.end());
    for (const auto& warning : warnings) {
        console.warn(warning);
    }
    if (options.profile) {
        with_trip_name(source.name(),
                       [&] { return write_profile_of(trace, chosen.vehicle, options, console); });
    }
    if (options.events) {
        const auto count = with_trip_name(source.name(), [&] {
            return write_events(*options.events,
                                trace,
                                TripPositions{trip},
                                antenna_ahead_m(trip.meta, chosen.vehicle));
        });
        console.say(fmt::format("{}: {}", options.events->string(), counted(count, "event")));
    }
    RowOutput output{options.output};
    if (options.survey) {
        print_against(survey, trip, trace, chosen.vehicle, options, console);
    } else {
        print_rows(trip, trace, chosen.vehicle, options);
    }
    output.commit();
}

constexpr std::array operands{
    Operand{.name = "TRIP",
            .help = "One trip log (.trip.csv, .gz, .zst) or phone export (folder or .zip).",
            .fallback = from_standard_input}};
constexpr std::array options{
    vehicle_option,
    vehicles_option,
    vehicle_id_option,
    mapping_option,
    positions_option,
    Option{"--length", "METRES", "Length of the reported segments.", "20"},
    method_option,
    channels_option,
    no_filters_option,
    rate_option,
    Option{"--live",
           "",
           "Write each row within 2 s of driving while the log is still growing, from TRIP or "
           "standard input."},
    Option{"--profile", "FILE.erd", "Also write the estimated elevation of the road, for ProVAL."},
    Option{"--events",
           "FILE",
           "Also write potholes, bumps, joints and rails: .csv, .json or .geojson."},
    in_group("comparison with a survey",
             {"--against",
              "SURVEY.csv",
              "Compare the trip with a survey, for each row of the survey that was driven."}),
    in_group(
        "comparison with a survey",
        {"--max-distance", "METRES", "Maximum distance of the trip from the survey line.", "8"}),
    in_group("comparison with a survey",
             {"--max-angle", "DEGREES", "Maximum angle between the two driving directions.", "30"}),
    one_of("mm/m|in/mi",
           in_group("comparison with a survey",
                    {"--unit", "UNIT", "IRI unit of the survey: mm/m or in/mi.", "mm/m"})),
    one_of("csv|json",
           {"--format", "NAME", "csv, or a JSON array.", "by the suffix of -o; otherwise csv"}),
    Option{"-o,--output",
           "FILE",
           "Write the rows to a .csv or .json file; with --against, .svg: plot survey and trip."},
    json_option,
    units_option};

} // namespace

const Command trace_command{
    .name = "trace",
    .summary = "Estimate the IRI along one trip, without a map",
    .about = "One row for each 20 m of travel, with the coordinates of its midpoint, the IRI in "
             "mm/m and its 90 %\n"
             "interval. index says which IRI it is: MRI where both wheel tracks were observed, "
             "otherwise HRI (of the\n"
             "mean profile). Where no estimate is possible, iri is empty and validity gives the "
             "reason: too_slow,\n"
             "start_up (the first 60 m of a continuous drive) or gap. indicative: from lateral "
             "acceleration only.",
    .example = "  macadam trace drive.trip.csv.gz --vehicle my_car.toml > iri.csv\n"
               "  macadam trace drive.trip.csv --length 100 --json\n"
               "  macadam trace drive.trip.csv --against laser.csv -o both.svg\n"
               "  sensor-program | macadam trace --live -",
    .operands = operands,
    .options = options,
    .run = run_trace};

} // namespace macadam
