#include "app/asked_trips.hpp"
#include "app/commands.hpp"
#include "app/estimation_options.hpp"
#include "app/import_trips.hpp"
#include "app/mapping_option.hpp"
#include "app/segment_options.hpp"
#include "app/store_patience.hpp"
#include "app/trip_outcome_output.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

constexpr std::int64_t most_jobs = 256;

std::size_t parse_jobs(const Arguments& arguments) {
    const auto jobs = arguments.integer("--jobs").value_or(1);
    if (jobs < 1 || jobs > most_jobs) {
        throw UsageError{fmt::format("--jobs is {}, expected 1 to {}", jobs, most_jobs)};
    }
    return static_cast<std::size_t>(jobs);
}

void run_reprocess(const Arguments& arguments, const Console& console) {
    const auto jobs = parse_jobs(arguments);
    auto config = pipeline_config_of(arguments);
    config.estimator.tracks = false; // as an import
    const auto& words = arguments.operands("PATH");
    VehicleChoice vehicles{arguments};
    const auto file = store_file(arguments);
    auto store = opened_store(file, RoadStore::Access::write, console);
    AskedTrips trips{{words.begin(), words.end()},
                     {.mapping = mapping_of(arguments), .most_files = max_members_of(arguments)},
                     console};
    const bool json = arguments.flag("--json");
    const auto tell = [&](const TripOutcome& outcome) { tell_of(outcome, json); };

    const auto working = console.progress("reprocessing");
    const auto totals = rework_trips(store, trips, vehicles, config, jobs, working, tell);
    working(1, 1); // takes the bar off the line
    if (totals.interrupted) {
        throw InputError{"interrupted: the store is as it was"};
    }
    if (totals.imported == 0) {
        throw InputError{fmt::format("no trip of {} was worked out anew: the store is as it was",
                                     counted(totals.looked_at(), "trip"))};
    }
    trips.tell_rest(console);
    const auto fusing = console.progress("fusing");
    const auto method = config.estimator.method == Method::kf ? "kf" : "smoother";
    const auto done = store.take_staged(fmt::format("method {}", method), fusing);
    console.say(fmt::format("generation {}: {} worked out anew, {} as before{}",
                            done.generation,
                            counted(done.trips, "trip"),
                            done.others,
                            done.calibrated ? "; the cars were calibrated anew" : ""));
    if (totals.rejected > 0) {
        throw InputError{fmt::format("{} rejected: these stay as they were, if they are in the "
                                     "store",
                                     counted(totals.rejected, "trip"))};
    }
}

constexpr std::array operands{
    store_operand,
    Operand{"PATH", "The logs of trips that are in the store, in whatever folders.", true}};

constexpr std::array options{
    vehicle_option,
    vehicles_option,
    mapping_option,
    Option{"--jobs", "N", "Trips to work on at once.", "1"},
    max_members_option,
    method_option,
    channels_option,
    no_filters_option,
    rate_option,
    Option{"--json", "", "One JSON object a trip on standard output, one a line."}};

} // namespace

const Command reprocess_command{
    .name = "reprocess",
    .summary = "Work trips of a store out anew: other cars, another method, a better version",
    .about = "Reads the logs again and puts what they say now in place of what they said before: a "
             "new generation, in\none transaction at the end. Until then, and if it is cut off, "
             "the store is as it was; readers see one\ngeneration or the other. Trips of the store "
             "whose logs are not among the paths stay as they are; logs of\nother trips are left "
             "out ('unknown').",
    .example = "  macadam reprocess roads.gpkg trips/ --vehicles better-cars/\n"
               "  macadam reprocess roads.gpkg trips/ --method kf --jobs 2",
    .operands = operands,
    .options = options,
    .run = run_reprocess};

} // namespace macadam
