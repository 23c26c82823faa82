#include "app/cli/server_commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/server_store.hpp"
#include "app/import/trip_options.hpp"
#include "app/import/trip_report_output.hpp"
#include "app/jobs/job_options.hpp"
#include "app/jobs/job_worker.hpp"
#include "app/reprocess/kept_trips.hpp"
#include "app/uploads/upload_workers.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/uploads/upload_database.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
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

constexpr std::int64_t default_lease_s = 60;

/// Works out the queue of a database on a server.
void run_job_worker(const std::string& address,
                    const Arguments& arguments,
                    const Console& console) {
    constexpr std::int64_t max_lease_s = 3600;
    const auto lease_s = arguments.integer("--lease").value_or(default_lease_s);
    if (lease_s < 1 || lease_s > max_lease_s) {
        throw UsageError{fmt::format("--lease is {}, expected 1 to {} s", lease_s, max_lease_s)};
    }
    const auto objects = arguments.value("--objects");
    auto import_arguments = upload_arguments(words_of(arguments));
    JobWork work{
        .address = address, .objects = {}, .import_arguments = std::move(import_arguments)};
    if (objects) {
        work.objects = absolute_location(*objects);
    }
    work.lease = std::chrono::seconds{lease_s};
    work.until_empty = arguments.flag("--once");
    work.keeps_logs = arguments.flag("--keep-logs");
    work.takes_over = arguments.flag("--take-over");
    work.tell = [&, json = arguments.flag("--json")](const TripReport& trip) {
        print_report(trip, json, console);
    };
    console.say("working; Ctrl-C ends");
    work_out_jobs(work, console);
}

void run_worker(const Arguments& arguments, const Console& console) {
    using namespace std::chrono_literals;
    const auto file = file_or_server(arguments);
    if (is_server_address(file.string())) {
        run_job_worker(file.string(), arguments, console);
        return;
    }
    for (const std::string name : {"--objects", "--keep-logs", "--lease", "--take-over"}) {
        if (arguments.is_given(name)) {
            throw UsageError{
                fmt::format("{} is for a database on a server, but STORE is a file", name)};
        }
    }
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
        erase_old_logs_of(file, uploads, console); // first, as an import may fail
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

constexpr std::array operands{import_operand};
constexpr std::array options{
    vehicles_option,
    method_option,
    jobs_option,
    in_group("server", objects_option),
    in_group("server",
             {"--keep-logs", "", "Leave logs in the object store once they are imported."}),
    rare(in_group("server",
                  {"--lease",
                   "SECONDS",
                   "After this time without a sign of a worker, others take its logs.",
                   "60"})),
    rare(in_group(
        "server",
        {"--take-over", "", "Compute with this program's version of results from now on."})),
    Option{"--once", "", "End when nothing waits."},
    Option{"--json", "", "One JSON object per trip on standard output, one per line."}};

} // namespace

const Command worker_command{
    .name = "worker",
    .summary = "Import the trips that wait: uploads, or those that were submitted",
    .about = "Beside a file: takes uploads of 'macadam serve' from the queue, imports them as "
             "'macadam import' does, erases the\n"
             "logs, and deletes the trips that contributors delete. A server has a worker of "
             "its own, unless --workers 0 is given.\n"
             "For postgresql://...: takes logs of 'macadam submit', on any number of machines. "
             "Each log counts once, whatever is\n"
             "killed; one at which its worker ended, or whose stored bytes are missing or "
             "damaged, is tried five times ('macadam\n"
             "status'). While the object store cannot be reached, logs wait.",
    .example = "  macadam worker roads.gpkg --vehicles cars/\n"
               "  macadam worker roads.gpkg --once\n"
               "  macadam worker postgresql://me@db.example.org/roads --jobs 4",
    .operands = operands,
    .options = options,
    .run = run_worker,
    .runs_until_stopped = true};

} // namespace macadam
