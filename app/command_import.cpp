#include "app/commands.hpp"
#include "app/estimation_options.hpp"
#include "app/import_trips.hpp"
#include "app/interruption.hpp"
#include "app/laid_words.hpp"
#include "app/mapping_option.hpp"
#include "app/printable.hpp"
#include "app/segment_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/json.hpp"
#include "storage/sha256.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace macadam {
namespace {

struct ImportOptions {
    std::filesystem::path store;
    std::vector<std::filesystem::path> paths;
    std::size_t jobs;
    bool json;
    PipelineConfig pipeline;
    std::shared_ptr<const TripMapping> mapping;
};

constexpr std::int64_t most_jobs = 256;
constexpr double most_trim_m = 100000;

PipelineConfig config_of(const Arguments& arguments) {
    auto config = pipeline_config_of(arguments);
    config.estimator.tracks = false; // a map lives by its headline
    config.trim_m = arguments.number("--trim", 0);
    if (!(config.trim_m >= 0 && config.trim_m <= most_trim_m)) {
        throw UsageError{
            fmt::format("--trim is {}, expected 0 to {} m", config.trim_m, most_trim_m)};
    }
    return config;
}

ImportOptions parse_import(const Arguments& arguments) {
    const auto jobs = arguments.integer("--jobs").value_or(1);
    if (jobs < 1 || jobs > most_jobs) {
        throw UsageError{fmt::format("--jobs is {}, expected 1 to {}", jobs, most_jobs)};
    }
    const auto& paths = arguments.operands("PATH");
    return {.store = store_file(arguments),
            .paths = {paths.begin(), paths.end()},
            .jobs = static_cast<std::size_t>(jobs),
            .json = arguments.flag("--json"),
            .pipeline = config_of(arguments),
            .mapping = mapping_of(arguments)};
}

std::string reasons_json(const RowCount& rows) {
    JsonObject reasons;
    for (const auto& [reason, count] : rows.reasons) {
        reasons.add(reason, static_cast<std::int64_t>(count));
    }
    return reasons.text();
}

std::string json_line(const TripOutcome& outcome) {
    const auto whole = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    const auto& trip = outcome.trip;
    JsonObject line;
    line.add("file", outcome.file)
        .add("trip_id", outcome.trip_id)
        .add("sha256", outcome.sha256)
        .add("result", std::string{name_of(outcome.result)})
        .add("rows_read", whole(trip.rows.read))
        .add("rows_used", whole(trip.rows.used))
        .add("rows_rejected", whole(trip.rows.rejected))
        .add("reasons", JsonRaw{reasons_json(trip.rows)})
        .add("distance_m", JsonNumber{trip.distance_m, 1})
        .add("matched_m", JsonNumber{trip.matched_m, 1})
        .add("passes", whole(trip.passes.size()))
        .add("vehicle", outcome.vehicle)
        .add("warnings", JsonRaw{json_string_array(trip.warnings)});
    if (!outcome.error.empty()) {
        line.add("error", outcome.error);
    }
    return line.text() + "\n";
}

std::string spoken(const RowCount& rows) {
    auto words = fmt::format("{} rows, {} used", rows.read, rows.used);
    std::string_view before = ", rejected: ";
    for (const auto& [reason, count] : rows.reasons) {
        words += fmt::format("{}{} {}", before, count, reason);
        before = ", ";
    }
    return words;
}

std::string notes(const std::vector<std::string>& warnings) {
    std::string lines;
    for (const auto& warning : warnings) {
        lines += fmt::format("          note: {}\n", printable_name(warning));
    }
    return lines;
}

std::string text_lines(const TripOutcome& outcome) {
    if (outcome.result == TripOutcome::Result::rejected) {
        return fmt::format("rejected  {}\n", printable_name(outcome.error));
    }
    const auto& trip = outcome.trip;
    if (outcome.result == TripOutcome::Result::known) {
        return fmt::format("known     {}\n", printable_name(outcome.file)) + notes(trip.warnings);
    }
    const auto lines =
        fmt::format("imported  {}: {}; {:.2f} km driven, {:.2f} km on the network; car '{}'\n"
                    "          {}\n",
                    printable_name(outcome.file),
                    counted(trip.passes.size(), "pass"),
                    trip.distance_m / 1000,
                    trip.matched_m / 1000,
                    printable_name(outcome.vehicle),
                    spoken(trip.rows));
    return lines + notes(trip.warnings);
}

/// The trips of the paths, and the paths that are none, as rejected.
struct Found {
    std::vector<TripSource> trips;
    std::vector<TripOutcome> refused;
};

Found trips_in(const std::vector<std::filesystem::path>& paths,
               const std::shared_ptr<const TripMapping>& mapping,
               const Console& console) {
    Found all;
    for (const auto& path : paths) {
        TripSearch found;
        try {
            found = find_trips(path, mapping);
        } catch (const InputError& error) {
            TripOutcome outcome;
            outcome.file = path.string();
            outcome.error = error.what();
            all.refused.push_back(std::move(outcome));
            continue;
        }
        if (found.trips.empty()) {
            console.warn(fmt::format(
                "{}: holds no trip log (*.trip.csv, *.trip.csv.gz, *.trip.csv.zst, *.rawlog), nor "
                "an export of phyphox or Sensor Logger",
                path.string()));
        }
        if (found.other_files > 0) {
            console.say(
                fmt::format("{}: {} other files were not read", path.string(), found.other_files));
        }
        all.trips.insert(all.trips.end(), found.trips.begin(), found.trips.end());
    }
    return all;
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
    return fmt::format("an earlier import of these paths ({}) did not end; {} came into the store "
                       "since it began: going on with the rest",
                       counted(earlier.trips_asked, "trip"),
                       counted(earlier.trips_added, "trip"));
}

void run_import(const Arguments& arguments, const Console& console) {
    const auto options = parse_import(arguments);
    VehicleChoice vehicles{arguments};
    auto store = RoadStore::open(options.store, RoadStore::Access::write);
    const auto [trips, refused] = trips_in(options.paths, options.mapping, console);
    const auto name = name_of_import(options.paths);
    if (const auto earlier = store.begin_import(name, trips.size())) {
        console.say(spoken(*earlier));
    }
    const Interruption interruption;

    const auto tell = [&](const TripOutcome& outcome) {
        if (options.json) {
            print(json_line(outcome));
        } else {
            print_words(text_lines(outcome));
        }
        flush_results();
    };
    std::ranges::for_each(refused, tell);
    auto importing = console.progress("importing");
    importing.stop = interruption.stop();
    auto totals =
        import_trips(store, trips, vehicles, options.pipeline, options.jobs, importing, tell);
    totals.rejected += refused.size();
    const auto fused = store.refresh(console.progress("fusing"));

    console.say(fmt::format("{} imported, {} known, {} rejected; {}, {} fused",
                            counted(totals.imported, "trip"),
                            totals.known,
                            totals.rejected,
                            counted(totals.passes, "pass"),
                            counted(fused, "segment")));
    if (const auto words = laid_words(store.laid()); fused > 0 && !words.empty()) {
        console.say(words);
    }
    if (totals.left > 0) {
        importing(1, 1); // takes the bar off the line
        throw InputError{fmt::format("interrupted: {} of {} were not looked at; the others are "
                                     "done, and the same command goes on with the rest",
                                     totals.left,
                                     counted(trips.size(), "trip"))};
    }
    store.end_import(name);
    if (totals.rejected > 0) {
        const auto asked = trips.size() + refused.size();
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
    Option{"--json", "", "One JSON object a trip on standard output, one a line."}};

} // namespace

const Command import_command{
    .name = "import",
    .summary = "Bring trip logs into a store: each trip once, every row accounted for",
    .about = "Each trip is read, its road roughness estimated, its way matched to the store's "
             "network and cut\n"
             "into passes over segments; then all passes over a segment are fused. One transaction "
             "a trip: what\n"
             "is reported as imported is on disk. A trip that is already in the store, under any "
             "name or\n"
             "compression, is 'known' and changes nothing. A trip that cannot be used is "
             "'rejected' with its\n"
             "reason and does not stop the others; the exit status is then 1.",
    .example = "  macadam import roads.gpkg trips/                     every log under trips/\n"
               "  macadam import roads.gpkg a.trip.csv.gz --vehicle generic\n"
               "  macadam import roads.gpkg trips/ --jobs 2 --json > import.jsonl",
    .operands = operands,
    .options = options,
    .run = run_import};

} // namespace macadam
