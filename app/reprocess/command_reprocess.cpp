#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/segment_options.hpp"
#include "app/database/server_store.hpp"
#include "app/import/import_outcome.hpp"
#include "app/import/import_trips.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/import/trip_options.hpp"
#include "app/import/trip_progress.hpp"
#include "app/import/trip_report_output.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/estimation_options.hpp"
#include "app/pipeline/results_version.hpp"
#include "app/reprocess/kept_trips.hpp"

#include "estimator/common/error.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/postgres/server_connection.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>

namespace macadam {
namespace {

/// \throws OtherResults  if workers of a database on a server compute others than this program.
void expect_results_of_workers(const std::string& store) {
    if (is_server_address(store)) {
        ServerConnection server{store};
        expect_results_version(server, results_version);
    }
}

void run_reprocess(const Arguments& arguments, const Console& console) {
    const auto jobs = jobs_of(arguments);
    auto config = pipeline_config_of(arguments);
    config.estimator.tracks = false; // as in an import
    const auto& words = arguments.operands("PATH");
    const auto logs_key = arguments.value("--logs-key");
    VehicleChoice vehicles{arguments};
    const auto file = file_or_server(arguments);
    if (words.empty() && !logs_key) {
        throw UsageError{"PATH is missing, expected logs, or --logs-key for those that a server "
                         "keeps"};
    }
    if (logs_key && is_server_address(file.string())) {
        throw UsageError{"--logs-key is for a crowd database, which is a file"};
    }
    auto store = opened_store(file, console);
    expect_results_of_workers(file.string());
    AskedTrips trips{{words.begin(), words.end()},
                     {.mapping = mapping_of(arguments),
                      .positions = arguments.value("--positions").value_or(""),
                      .max_files = max_members_of(arguments)},
                     console};
    const bool json = arguments.flag("--json");
    std::optional<KeptTrips> kept;
    if (logs_key) {
        kept.emplace(file, *logs_key, trips, console);
    }
    const auto tell = [&](const TripReport& trip) {
        print_report(kept ? kept->named(trip) : trip, json, console);
    };

    const auto working =
        console.progress("reprocessing", {.name = "trip", .parts = TripProgress::whole_trip});
    const ImportWork work{.pipeline = config, .jobs = jobs, .restaged = &store.maintenance};
    auto target = import_store_of(store);
    const auto totals = import_trips(target, trips, vehicles, work, working, tell);
    if (totals.interrupted) {
        throw InputError{"interrupted: the database is unchanged"};
    }
    expect_on_map(totals, store, console);
    if (totals.imported == 0) {
        throw InputError{fmt::format("no trip of {} was reprocessed: the database is unchanged",
                                     counted(totals.looked_at(), "trip"))};
    }
    trips.tell_rest(console);
    expect_results_of_workers(file.string()); // who may have changed meanwhile
    const auto fusing = console.progress("fusing");
    const auto method = config.estimator.method == Method::kf ? "kf" : "smoother";
    const auto done = store.maintenance.commit_staged(fmt::format("method {}", method), fusing);
    console.say(fmt::format("generation {}: {} reprocessed, {} unchanged{}",
                            done.generation,
                            counted(done.trips, "trip"),
                            done.others,
                            done.calibrated ? "; the cars were recalibrated" : ""));
    if (totals.rejected > 0) {
        throw InputError{fmt::format("{} rejected: they stay unchanged if they are in the "
                                     "database",
                                     counted(totals.rejected, "trip"))};
    }
}

constexpr std::array operands{
    import_operand,
    Operand{.name = "PATH",
            .help = "Logs of trips that are already in the database, in any folders.",
            .many = true,
            .optional = true}};

constexpr auto options = trip_options_and(std::array{
    Option{"--logs-key",
           "FILE",
           "Also the logs that the server keeps ('init --keep-logs'), opened by this key."}});

} // namespace

const Command reprocess_command{
    .name = "reprocess",
    .summary = "Reprocess imported trips: with other cars, another method or a newer version",
    .about = "Reads the logs again and replaces the passes of their trips: a new generation, "
             "written in one transaction\n"
             "at the end. Until then, and after an interruption, the database is unchanged; "
             "readers see either the old\n"
             "generation or the new one. Trips whose logs are not among the paths stay as they "
             "are; logs of trips that\n"
             "are not in the database are skipped ('unknown').",
    .example = "  macadam reprocess roads.gpkg trips/ --vehicles better-cars/\n"
               "  macadam reprocess roads.gpkg trips/ --method kf --jobs 2\n"
               "  macadam reprocess crowd.gpkg --logs-key logs.key",
    .operands = operands,
    .options = options,
    .run = run_reprocess};

} // namespace macadam
