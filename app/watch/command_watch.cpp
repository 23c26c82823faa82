#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/server_store.hpp"
#include "app/import/import_outcome.hpp"
#include "app/import/import_run.hpp"
#include "app/import/trip_options.hpp"
#include "app/watch/folder_changes.hpp"
#include "app/watch/settled_trips.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <set>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// Interval of looking into a folder whose changes are noticed, and of one whose changes are not.
constexpr auto look_every = 60s;
constexpr auto look_blindly_every = 15s;

/// Imports trips over a connection of their own, so that the database is closed in between.
void import_batch(const fs::path& file,
                  const std::vector<fs::path>& trips,
                  const ImportOptions& options,
                  const Arguments& arguments,
                  const Console& console) {
    VehicleChoice vehicles{arguments}; // also of cars that were added meanwhile
    auto store = opened_for_import(file, console);
    const auto totals = import_paths(store, trips, options, vehicles, console);
    warn_of_earlier_settings(totals, file, options.named_after, console);
    try {
        expect_on_map(totals, store.map, console);
    } catch (const InputError& all_outside) {
        console.warn(all_outside.what());
    }
}

void say_how_watched(const fs::path& folder, const std::string& blindness, const Console& console) {
    console.say(blindness.empty()
                    ? fmt::format("watching {}; Ctrl-C ends", folder.string())
                    : fmt::format("{}: {}; looking for new files every {} s; Ctrl-C ends",
                                  folder.string(),
                                  blindness,
                                  look_blindly_every.count()));
}

/// Returns the trips that are complete; empty if the folder cannot be read as it is now, such as
/// while a folder below it vanishes. A reason that lasts is told once.
std::vector<fs::path> take(SettledTrips& trips,
                           const fs::path& folder,
                           const std::set<fs::path>& closed,
                           std::string& reason,
                           const Console& console) {
    try {
        auto complete = trips.take(closed);
        reason.clear();
        return complete;
    } catch (const InputError& error) {
        if (!fs::is_directory(folder)) {
            throw InputError{fmt::format("{}: the watched folder is gone: moved, removed, or on a "
                                         "drive that was taken away; what was reported is in the "
                                         "database. Start the command again when it is back",
                                         folder.string())};
        }
        if (reason != error.what()) {
            reason = error.what();
            console.warn(fmt::format("{}; no trip of the folder is imported until then", reason));
        }
        return {};
    }
}

void run_watch(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    const fs::path folder = arguments.operand("FOLDER");
    auto options = parse_import(arguments);
    options.named_after = folder;
    options.tells_known = false;
    if (!fs::is_directory(folder)) {
        throw InputError{fmt::format("{}: is not a folder, expected the folder in which trip logs "
                                     "appear",
                                     folder.string())};
    }
    static_cast<void>(VehicleChoice{arguments});                 // refuses bad values at once,
    warn_of_importer(opened_for_import(file, console), console); // as well as a bad database

    FolderChanges changes{folder};
    SettledTrips trips{folder, {.mapping = options.mapping, .max_files = options.max_members}};
    auto blindness = changes.blindness();
    say_how_watched(folder, blindness, console);
    std::set<fs::path> closed;
    std::string reason;
    while (!console.stop().stop_requested()) {
        if (const auto complete = take(trips, folder, closed, reason, console); !complete.empty()) {
            try {
                import_batch(file, complete, options, arguments, console);
            } catch (const InputError&) {
                if (!console.stop().stop_requested()) {
                    throw;
                }
            }
        }
        const auto pause = trips.has_incomplete()        ? SettledTrips::settling
                           : changes.blindness().empty() ? look_every
                                                         : look_blindly_every;
        closed = changes.wait(pause, console.stop());
        if (changes.blindness() != blindness) { // such as when there are too many folders
            blindness = changes.blindness();
            say_how_watched(folder, blindness, console);
        }
    }
    console.say("stopped; what was reported is in the database");
}

constexpr std::array operands{
    import_operand, Operand{"FOLDER", "The folder in which trip logs appear, at any depth."}};

constexpr auto options = trip_options_and(std::array{trim_option});

} // namespace

const Command watch_command{
    .name = "watch",
    .summary = "Import trip logs as they appear in a folder, until stopped",
    .about =
        "Imports what is in the folder and then each trip log that is added, as 'macadam import' "
        "does. A log is taken\n"
        "when its writer has closed it, when it was moved into the folder, or when it did not "
        "change for 10 s, and\n"
        "when a macadam-trip log has its end row. Rejected files are reported once. INT and TERM "
        "(Ctrl-C) end the\n"
        "command with exit status 0; started again, it continues with what is not in the "
        "database yet.",
    .example = "  macadam watch roads.gpkg incoming/\n"
               "  macadam watch roads.gpkg incoming/ --vehicles cars/ --json >> import.jsonl   "
               "(docs/reference/nightly-import.md)",
    .operands = operands,
    .options = options,
    .run = run_watch,
    .runs_until_stopped = true};

} // namespace macadam
