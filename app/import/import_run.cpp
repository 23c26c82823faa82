#include "app/import/import_run.hpp"

#include "app/cli/interrupt_handler.hpp"
#include "app/database/key_messages.hpp"
#include "app/import/alignment_summary.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/import/trip_progress.hpp"
#include "app/import/trip_report_output.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/estimation_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stop_token>
#include <utility>

namespace macadam {
namespace {

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

/// Records the start of an import, and says whether it continues an earlier one or runs beside
/// another.
void begin_import(ImportTarget& trips,
                  const std::string& name,
                  std::size_t trips_asked,
                  const Console& console) {
    const auto begun = trips.begin_import(name, trips_asked);
    if (begun.same_runs) {
        console.say("another import of these paths is running; trips that it has stored are "
                    "skipped");
    } else if (begun.other_runs) {
        console.say("another import into this database is running");
    }
    if (begun.earlier && !begun.same_runs) {
        console.say(spoken(*begun.earlier));
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

/// \returns the number of segments, with those of the earlier fusions of the import.
std::size_t fuse(ImportTarget& trips, const Console& console, FusionRecord record) {
    auto fusing = console.progress("fusing");
    trips.refresh(console.stop().stop_requested() ? until_it_takes_long(std::move(fusing)) : fusing,
                  record,
                  BusyChunks::await);
    return record.segments.size();
}

void expect_all_fused(ImportTarget& trips, const Console& console) {
    const auto waiting = console.stop().stop_requested() ? trips.waiting() : 0;
    if (waiting > 0) {
        throw InputError{fmt::format("interrupted: all trips are in the database, but {} are "
                                     "not fused yet; run the same command again to continue",
                                     counted(waiting, "segment"))};
    }
}

void expect_all_read(const ImportTotals& totals, const AskedTrips& trips) {
    if (!totals.interrupted) {
        return;
    }
    const auto count = trips.count();
    const auto left =
        count ? fmt::format("{} of {}", *count - totals.looked_at(), counted(*count, "trip"))
              : std::string{"the rest of the trips in archives"};
    throw InputError{fmt::format("interrupted: {} were not read; the others are done, run "
                                 "the same command again to continue",
                                 left)};
}

void say_totals(const ImportTotals& totals, std::size_t fused, const Console& console) {
    const auto outside = totals.outside.empty()
                             ? std::string{}
                             : fmt::format(", {} outside the map", totals.outside.size());
    console.say(fmt::format("{} imported, {} already imported, {} rejected{}; {}, {} fused",
                            counted(totals.imported, "trip"),
                            totals.known,
                            totals.rejected,
                            outside,
                            counted(totals.passes, "pass"),
                            counted(fused, "segment")));
}

} // namespace

ImportOptions parse_import(const Arguments& arguments) {
    return {.jobs = jobs_of(arguments),
            .json = arguments.flag("--json"),
            .pipeline = config_of(arguments),
            .mapping = mapping_of(arguments),
            .positions = arguments.value("--positions").value_or(""),
            .max_members = max_members_of(arguments)};
}

ImportTotals import_paths(ImportStore& store,
                          const std::vector<std::filesystem::path>& paths,
                          const ImportOptions& options,
                          VehicleChoice& vehicles,
                          const Console& console) {
    make_missing_key(*store.trips, console);
    AskedTrips trips{paths,
                     {.mapping = options.mapping,
                      .positions = options.positions,
                      .max_files = options.max_members},
                     console};
    const auto name =
        name_of_import(options.named_after.empty() ? paths : std::vector{options.named_after});
    begin_import(*store.trips, name, trips.count().value_or(0), console);

    auto totals = import_trips(
        store,
        trips,
        vehicles,
        {.pipeline = options.pipeline,
         .jobs = options.jobs,
         .readmit = options.readmit,
         .warn = [&](const std::string& words) { console.say(words); }},
        console.progress("importing", {.name = "trip", .parts = TripProgress::whole_trip}),
        [&](const TripReport& trip) {
            if (options.tell) {
                options.tell(trip);
            } else if (options.tells_known || trip.result != TripReport::Result::known) {
                print_report(trip, options.json, console);
            }
        });
    const auto fused = fuse(*store.trips, console, totals.fusion);
    say_totals(totals, fused, console);
    if (const auto words = alignment_summary_text(store.trips->alignment());
        fused > 0 && !words.empty()) {
        console.say(words);
    }
    expect_all_read(totals, trips);
    trips.tell_rest(console);
    expect_all_fused(*store.trips, console);
    store.trips->end_import(name);
    return totals;
}

std::size_t fuse_new_passes(ImportStore& store, const Console& console) {
    const auto fused = fuse(*store.trips, console, {});
    expect_all_fused(*store.trips, console);
    return fused;
}

} // namespace macadam
