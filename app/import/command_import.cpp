#include "app/cli/commands.hpp"
#include "app/cli/interrupt_handler.hpp"
#include "app/database/key_messages.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/segment_options.hpp"
#include "app/import/alignment_summary.hpp"
#include "app/import/import_references.hpp"
#include "app/import/import_trips.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/import/trip_report_output.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/estimation_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/surveys/control_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <stop_token>
#include <utility>

namespace macadam {
namespace {

struct ImportOptions {
    std::filesystem::path store;
    std::vector<std::filesystem::path> paths;
    std::size_t jobs;
    bool json;
    bool readmit;
    PipelineConfig pipeline;
    std::shared_ptr<const TripMapping> mapping;
    std::size_t max_members;
    KnownRoughness known;
};

constexpr double max_trim_m = 100000;

PipelineConfig config_of(const Arguments& arguments) {
    auto config = pipeline_config_of(arguments);
    config.estimator.tracks = false; // a map needs the headline value only
    config.trim.min_m = arguments.number("--trim", 0);
    if (!(config.trim.min_m >= 0 && config.trim.min_m <= max_trim_m)) {
        throw UsageError{
            fmt::format("--trim is {}, expected 0 to {} m", config.trim.min_m, max_trim_m)};
    }
    return config;
}

ImportOptions parse_import(const Arguments& arguments) {
    const auto jobs = jobs_of(arguments);
    const auto& paths = arguments.operands("PATH");
    auto known = parse_known_roughness(arguments);
    if (paths.empty() && !known.survey && !known.control) {
        throw UsageError{"PATH is missing"};
    }
    return {.store = store_file(arguments),
            .paths = {paths.begin(), paths.end()},
            .jobs = jobs,
            .json = arguments.flag("--json"),
            .readmit = arguments.flag("--take-back"),
            .pipeline = config_of(arguments),
            .mapping = mapping_of(arguments),
            .max_members = max_members_of(arguments),
            .known = std::move(known)};
}

/// Returns the name of an import: the same for the same paths, from any working directory.
std::string name_of_import(const std::vector<std::filesystem::path>& paths) {
    Sha256 hash;
    for (const auto& path : paths) {
        hash.add(std::filesystem::absolute(path).lexically_normal().string() + '\n');
    }
    return hash.hex();
}

std::string spoken(const OpenImport& earlier) {
    const auto asked = earlier.trips_asked > 0
                           ? fmt::format(" ({})", counted(earlier.trips_asked, "trip"))
                           : std::string{}; // unknown: archives were included
    return fmt::format("an earlier import of these paths{} was interrupted after importing {}; "
                       "continuing with the rest",
                       asked,
                       counted(earlier.trips_added, "trip"));
}

void import_known(RoadStore& store, const ImportOptions& options, const Console& console) {
    const auto& known = options.known;
    const auto roads =
        load_or_build_network(store, [&](const std::string& words) { console.say(words); });
    if (known.survey) {
        const auto outcome = import_survey(store, roads, known);
        if (options.json) {
            print(json_line(outcome));
        } else if (!console.is_quiet()) {
            print_words(text_lines(outcome));
        } else {
            for (const auto& warning : outcome.warnings) {
                console.warn(fmt::format("{}: {}", outcome.file, warning));
            }
        }
        flush_results();
    }
    if (known.control) {
        const auto sections = read_control_sections(*known.control, roads, known.mm_per_m_of_one);
        store.maintenance.put_control_sections(sections);
        console.say(fmt::format("{}: {} stored; 'macadam info' compares the cars with them",
                                known.control->string(),
                                counted(sections.size(), "control section")));
    }
}

/// Limits fusing after an interruption to a short time.
Progress until_it_takes_long(Progress fusing) {
    std::stop_source late;
    fusing.stop = late.get_token();
    fusing.report = [late,
                     end = std::chrono::steady_clock::now() +
                           InterruptHandler::grace_period() / 3](std::size_t, std::size_t) mutable {
        if (std::chrono::steady_clock::now() > end) {
            late.request_stop();
        }
    };
    return fusing;
}

std::size_t fuse(RoadStore& store, const Console& console) {
    auto fusing = console.progress("fusing");
    return store.importer.refresh(
        console.stop().stop_requested() ? until_it_takes_long(std::move(fusing)) : fusing);
}

void expect_all_fused(const StoreReader& store, const Console& console) {
    if (console.stop().stop_requested() && store.waiting() > 0) {
        throw InputError{fmt::format("interrupted: all trips are in the database, but {} are "
                                     "not fused yet; run the same command again to continue",
                                     counted(store.waiting(), "segment"))};
    }
}

void fuse_new(RoadStore& store, const Console& console) {
    const auto fused = fuse(store, console);
    expect_all_fused(store, console);
    console.say(fmt::format("{} fused", counted(fused, "segment")));
}

void run_import(const Arguments& arguments, const Console& console) {
    const auto options = parse_import(arguments);
    VehicleChoice vehicles{arguments};
    auto store = opened_store(options.store, console);
    if (options.known.survey || options.known.control) {
        import_known(store, options, console);
    }
    if (options.paths.empty()) {
        fuse_new(store, console);
        return;
    }
    make_missing_key(store, console);
    AskedTrips trips{
        options.paths, {.mapping = options.mapping, .max_files = options.max_members}, console};
    const auto name = name_of_import(options.paths);
    if (const auto earlier = store.importer.begin_import(name, trips.count().value_or(0))) {
        console.say(spoken(*earlier));
    }

    const auto tell = [&](const TripReport& trip) { print_report(trip, options.json, console); };
    const auto importing = console.progress("importing");
    const auto totals =
        import_trips(store,
                     trips,
                     vehicles,
                     {.pipeline = options.pipeline,
                      .jobs = options.jobs,
                      .readmit = options.readmit,
                      .warn = [&](const std::string& words) { console.say(words); }},
                     importing,
                     tell);
    const auto fused = fuse(store, console);

    console.say(fmt::format("{} imported, {} already imported, {} rejected; {}, {} fused",
                            counted(totals.imported, "trip"),
                            totals.known,
                            totals.rejected,
                            counted(totals.passes, "pass"),
                            counted(fused, "segment")));
    if (const auto words = alignment_summary_text(store.laid()); fused > 0 && !words.empty()) {
        console.say(words);
    }
    importing(1, 1); // clears the progress bar
    if (totals.interrupted) {
        const auto count = trips.count();
        const auto left =
            count ? fmt::format("{} of {}", *count - totals.looked_at(), counted(*count, "trip"))
                  : std::string{"the rest of the trips in archives"};
        throw InputError{fmt::format("interrupted: {} were not read; the others are done, run "
                                     "the same command again to continue",
                                     left)};
    }
    trips.tell_rest(console);
    expect_all_fused(store, console);
    store.importer.end_import(name);
    if (totals.rejected > 0) {
        const auto asked = totals.looked_at();
        throw InputError{
            fmt::format("{} of {} rejected{}",
                        totals.rejected,
                        counted(asked, "trip"),
                        totals.rejected < asked ? "; the others are in the database" : "")};
    }
}

constexpr std::array operands{
    store_operand,
    Operand{"PATH",
            "Trip logs, phone exports, folders containing them (at any depth) or archives (.zip, "
            ".tar.gz).",
            true,
            "",
            true}};

constexpr std::array options{
    vehicle_option,
    vehicles_option,
    vehicle_id_option,
    mapping_option,
    Option{
        "--trim", "METRES", "Remove the first and last N metres of each trip, for privacy.", "0"},
    jobs_option,
    method_option,
    channels_option,
    no_filters_option,
    rate_option,
    max_members_option,
    Option{"--take-back", "", "Re-admit trips that 'macadam forget' deleted."},
    reference_option,
    accuracy_option,
    reference_date_option,
    reference_name_option,
    control_option,
    known_unit_option,
    Option{"--json", "", "One JSON object per trip on standard output, one per line."}};

} // namespace

const Command import_command{
    .name = "import",
    .summary = "Import trip logs: each trip once, every row accounted for",
    .about = "Reads each trip, estimates the roughness of its road, matches it to the road network "
             "and cuts it into\n"
             "passes over segments; then fuses all passes over each segment. A trip reported as "
             "imported is on disk;\n"
             "trips that follow each other within a second are committed together. A trip that is "
             "already in the\n"
             "database, under any name or compression, is skipped. A trip that cannot be used is "
             "rejected with the\n"
             "reason and does not stop the others; the exit status is then 1.\n"
             "--reference and --control import surveys and control sections instead of trips; PATH "
             "may be omitted.",
    .example = "  macadam import roads.gpkg trips/                     every log under trips/\n"
               "  macadam import roads.gpkg a.trip.csv.gz --vehicle generic\n"
               "  macadam import roads.gpkg trips/ --jobs 2 --json > import.jsonl\n"
               "  macadam import roads.gpkg --reference laser.csv --date 2026-03-01   "
               "(docs/reference/reference-surveys.md)",
    .operands = operands,
    .options = options,
    .run = run_import};

} // namespace macadam
