#include "app/asked_trips.hpp"
#include "app/commands.hpp"
#include "app/estimation_options.hpp"
#include "app/import_references.hpp"
#include "app/import_trips.hpp"
#include "app/interruption.hpp"
#include "app/key_words.hpp"
#include "app/laid_words.hpp"
#include "app/mapping_option.hpp"
#include "app/segment_options.hpp"
#include "app/store_patience.hpp"
#include "app/trip_outcome_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/control_reader.hpp"
#include "storage/network_file.hpp"
#include "storage/sha256.hpp"

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
    bool take_back;
    PipelineConfig pipeline;
    std::shared_ptr<const TripMapping> mapping;
    std::size_t max_members;
    KnownRoughness known;
};

constexpr std::int64_t most_jobs = 256;
constexpr double most_trim_m = 100000;

PipelineConfig config_of(const Arguments& arguments) {
    auto config = pipeline_config_of(arguments);
    config.estimator.tracks = false; // a map lives by its headline
    config.trim.min_m = arguments.number("--trim", 0);
    if (!(config.trim.min_m >= 0 && config.trim.min_m <= most_trim_m)) {
        throw UsageError{
            fmt::format("--trim is {}, expected 0 to {} m", config.trim.min_m, most_trim_m)};
    }
    return config;
}

ImportOptions parse_import(const Arguments& arguments) {
    const auto jobs = arguments.integer("--jobs").value_or(1);
    if (jobs < 1 || jobs > most_jobs) {
        throw UsageError{fmt::format("--jobs is {}, expected 1 to {}", jobs, most_jobs)};
    }
    const auto& paths = arguments.operands("PATH");
    auto known = parse_known_roughness(arguments);
    if (paths.empty() && !known.survey && !known.control) {
        throw UsageError{"PATH is missing"};
    }
    return {.store = store_file(arguments),
            .paths = {paths.begin(), paths.end()},
            .jobs = static_cast<std::size_t>(jobs),
            .json = arguments.flag("--json"),
            .take_back = arguments.flag("--take-back"),
            .pipeline = config_of(arguments),
            .mapping = mapping_of(arguments),
            .max_members = max_members_of(arguments),
            .known = std::move(known)};
}

/// The same paths, asked for from wherever, have the same name.
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
                           : std::string{}; // archives were among them
    return fmt::format("an earlier import of these paths{} did not end; {} came into the store "
                       "since it began: going on with the rest",
                       asked,
                       counted(earlier.trips_added, "trip"));
}

void import_known(RoadStore& store, const ImportOptions& options, const Console& console) {
    const auto& known = options.known;
    const auto roads = kept_roads(store, [&](const std::string& words) { console.say(words); });
    if (known.survey) {
        const auto outcome = import_survey(store, roads, known);
        if (options.json) {
            print(json_line(outcome));
        } else {
            print_words(text_lines(outcome));
        }
        flush_results();
    }
    if (known.control) {
        const auto sections = read_control_sections(*known.control, roads, known.mm_per_m_of_one);
        store.put_control_sections(sections);
        console.say(fmt::format("{}: {} kept; 'macadam info' watches the cars by them",
                                known.control->string(),
                                counted(sections.size(), "control section")));
    }
}

/// After an interruption, what came in before it is fused as far as that goes quickly.
Progress until_it_takes_long(Progress fusing) {
    std::stop_source late;
    fusing.stop = late.get_token();
    fusing.report = [late, end = std::chrono::steady_clock::now() + Interruption::patience() / 3](
                        std::size_t, std::size_t) mutable {
        if (std::chrono::steady_clock::now() > end) {
            late.request_stop();
        }
    };
    return fusing;
}

std::size_t fuse(RoadStore& store, const Console& console) {
    auto fusing = console.progress("fusing");
    return store.refresh(console.stop().stop_requested() ? until_it_takes_long(std::move(fusing))
                                                         : fusing);
}

void expect_all_fused(const RoadStore& store, const Console& console) {
    if (console.stop().stop_requested() && store.waiting() > 0) {
        throw InputError{fmt::format("interrupted: all trips are in the store, but {} wait to be "
                                     "fused; the same command goes on with them",
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
    auto store = opened_store(options.store, RoadStore::Access::write, console);
    if (options.known.survey || options.known.control) {
        import_known(store, options, console);
    }
    if (options.paths.empty()) {
        fuse_new(store, console);
        return;
    }
    make_missing_key(store, console);
    AskedTrips trips{
        options.paths, {.mapping = options.mapping, .most_files = options.max_members}, console};
    const auto name = name_of_import(options.paths);
    if (const auto earlier = store.begin_import(name, trips.count().value_or(0))) {
        console.say(spoken(*earlier));
    }

    const auto tell = [&](const TripOutcome& outcome) { tell_of(outcome, options.json); };
    const auto importing = console.progress("importing");
    const auto totals = import_trips(
        store,
        trips,
        vehicles,
        options.pipeline,
        {options.jobs, options.take_back, [&](const std::string& words) { console.say(words); }},
        importing,
        tell);
    const auto fused = fuse(store, console);

    console.say(fmt::format("{} imported, {} known, {} rejected; {}, {} fused",
                            counted(totals.imported, "trip"),
                            totals.known,
                            totals.rejected,
                            counted(totals.passes, "pass"),
                            counted(fused, "segment")));
    if (const auto words = laid_words(store.laid()); fused > 0 && !words.empty()) {
        console.say(words);
    }
    importing(1, 1); // takes the bar off the line
    if (totals.interrupted) {
        const auto count = trips.count();
        const auto left =
            count ? fmt::format("{} of {}", *count - totals.looked_at(), counted(*count, "trip"))
                  : std::string{"the rest of the trips in archives"};
        throw InputError{fmt::format("interrupted: {} were not looked at; the others are "
                                     "done, and the same command goes on with the rest",
                                     left)};
    }
    trips.tell_rest(console);
    expect_all_fused(store, console);
    store.end_import(name);
    if (totals.rejected > 0) {
        const auto asked = totals.looked_at();
        throw InputError{
            fmt::format("{} of {} rejected{}",
                        totals.rejected,
                        counted(asked, "trip"),
                        totals.rejected < asked ? "; the others are in the store" : "")};
    }
}

constexpr std::array operands{
    store_operand,
    Operand{
        "PATH",
        "Trip logs, phones' exports, folders of them (to any depth), or archives (.zip, .tar.gz).",
        true,
        "",
        true}};

constexpr std::array options{
    vehicle_option,
    vehicles_option,
    mapping_option,
    Option{"--trim",
           "METRES",
           "Leave out the first and the last metres of each trip, where people live.",
           "0"},
    Option{"--jobs", "N", "Trips to work on at once.", "1"},
    method_option,
    channels_option,
    no_filters_option,
    rate_option,
    max_members_option,
    Option{"--take-back", "", "Let trips in again that 'macadam forget' took out."},
    reference_option,
    accuracy_option,
    reference_date_option,
    reference_name_option,
    control_option,
    known_unit_option,
    Option{"--json", "", "One JSON object a trip on standard output, one a line."}};

} // namespace

const Command import_command{
    .name = "import",
    .summary = "Bring trip logs into a store: each trip once, every row accounted for",
    .about =
        "Each trip is read, its road roughness estimated, its way matched to the store's "
        "network and cut\n"
        "into passes over segments; then all passes over a segment are fused. What is reported "
        "as imported\n"
        "is on disk; trips that follow each other within a second go there together. A trip that "
        "is already in the store, under any "
        "name or\n"
        "compression, is 'known' and changes nothing. A trip that cannot be used is "
        "'rejected' with its\n"
        "reason and does not stop the others; the exit status is then 1.\n"
        "--reference and --control bring what is known of roads from elsewhere; PATH is not "
        "needed with them.",
    .example =
        "  macadam import roads.gpkg trips/                     every log under trips/\n"
        "  macadam import roads.gpkg a.trip.csv.gz --vehicle generic\n"
        "  macadam import roads.gpkg trips/ --jobs 2 --json > import.jsonl\n"
        "  macadam import roads.gpkg --reference laser.csv --date 2026-03-01   (docs/reference.md)",
    .operands = operands,
    .options = options,
    .run = run_import};

} // namespace macadam
