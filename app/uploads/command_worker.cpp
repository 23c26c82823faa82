#include "app/cli/server_commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/segment_options.hpp"
#include "app/import/trip_options.hpp"
#include "app/import/trip_report_output.hpp"
#include "app/uploads/upload_workers.hpp"
#include "storage/uploads/upload_database.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace macadam {
namespace {

/// Returns the options of the command line that `import` has, too.
std::vector<std::string> words_of(const Arguments& arguments) {
    std::vector<std::string> words;
    for (const std::string name : {"--vehicles", "--method", "--jobs"}) {
        if (const auto value = arguments.value(name)) {
            words.insert(words.end(), {name, *value});
        }
    }
    return words;
}

void run_worker(const Arguments& arguments, const Console& console) {
    using namespace std::chrono_literals;
    const auto file = store_file(arguments);
    static_cast<void>(opened_store(file, console)); // refuses other files
    make_uploads_folder(file);
    std::mutex printing;
    const UploadWork work{.store = file,
                          .arguments = upload_arguments(words_of(arguments)),
                          .tell = [&, json = arguments.flag("--json")](const TripReport& trip) {
                              const std::scoped_lock lock{printing};
                              print_report(trip, json, console);
                          }};
    if (arguments.flag("--once")) {
        auto uploads = open_uploads(file, wait_policy_for(file, console));
        sweep_spool(uploads, spool_of(file));
        while (work_out_uploads(uploads, work, console)) {
        }
        return;
    }
    const UploadWorkers workers{work, 1, console};
    console.say("waiting for uploads; Ctrl-C ends");
    while (!console.stop().stop_requested()) {
        std::this_thread::sleep_for(100ms); // a signal must not meet a lock of ours
    }
}

constexpr std::array operands{store_operand};
constexpr std::array options{
    vehicles_option,
    method_option,
    jobs_option,
    Option{"--once", "", "End when nothing waits."},
    Option{"--json", "", "One JSON object per trip on standard output, one per line."}};

} // namespace

const Command worker_command{
    .name = "worker",
    .summary = "Import the trips that a server has received, until stopped",
    .about = "Takes uploads of 'macadam serve' from the queue beside the database, imports them as "
             "'macadam import' does, and\n"
             "erases the logs; deletes the trips that contributors delete. Several workers share "
             "the queue. A server has one of\n"
             "its own, unless --workers 0 is given.",
    .example = "  macadam worker roads.gpkg --vehicles cars/\n"
               "  macadam worker roads.gpkg --once",
    .operands = operands,
    .options = options,
    .run = run_worker,
    .runs_until_stopped = true};

} // namespace macadam
