#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/segment_options.hpp"
#include "app/database/server_store.hpp"
#include "app/jobs/forgotten_logs.hpp"
#include "app/store/log_backlog.hpp"
#include "app/uploads/upload_work.hpp"

#include "storage/postgres/server_address.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace macadam {
namespace {

std::string json_of(const Forgotten& forgotten) {
    const auto whole = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    JsonObject object;
    object.add("trips", whole(forgotten.trips))
        .add("passes", whole(forgotten.passes))
        .add("segments", whole(forgotten.segments))
        .add("calibrated_anew", forgotten.calibrated)
        .add("log_is_clean", forgotten.log_is_clean);
    return object.text() + "\n";
}

RoadStore
opened_to_forget(const std::string& address, const ForgetRequest& request, const Console& console) {
    console.detail(fmt::format("opening {}", address));
    return RoadStore{open_replica_to_forget(
        address, request, wait_policy_for(address, console), console.progress("reading drives"))};
}

void run_forget(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    const ForgetRequest request{.trips = arguments.values("--trip"),
                                .vehicles = arguments.values("--vehicle-id")};
    if (request.trips.empty() && request.vehicles.empty()) {
        throw UsageError{"expected --trip or --vehicle-id: what to delete"};
    }
    const bool is_on_server = is_server_address(file.string());
    if (is_on_server) { // so that what is forgotten does not come in later
        work_out_backlog(file.string(), console);
    } else {
        work_out_all_uploads(file, console);
    }
    auto store = is_on_server ? opened_to_forget(file.string(), request, console)
                              : opened_store(file, console);
    const auto progress = console.progress("deleting");
    const auto forgotten = store.maintenance.forget(request, progress);
    if (is_on_server) {
        erase_forgotten_logs(file.string(), console);
    } else {
        drop_forgotten_uploads(store, console);
    }
    if (arguments.flag("--json")) {
        print(json_of(forgotten));
    } else {
        print_words(
            fmt::format("{} permanently deleted: {} over {}{}\n",
                        counted(forgotten.trips, "trip"),
                        counted(forgotten.passes, "pass"),
                        counted(forgotten.segments, "segment"),
                        forgotten.calibrated ? "; the cars were recalibrated without them" : ""));
    }
    if (!forgotten.log_is_clean) {
        console.warn(fmt::format("{}-wal: another program is reading the database, so its log "
                                 "still contains the deleted data until the last reader closes "
                                 "it",
                                 file.string()));
    }
}

constexpr std::array operands{import_operand};
constexpr std::array options{
    Option{"--trip", "TRIP", "Trips by trip_id, file name or SHA-256 of the content.", "", true},
    formerly("--vehicle",
             {"--vehicle-id",
              "ID",
              "All trips of these cars, by vehicle_id or by pseudonym ('macadam info').",
              "",
              true}),
    Option{"--json", "", "Print the result as one JSON object."}};

} // namespace

const Command forget_command{
    .name = "forget",
    .summary = "Permanently delete trips or cars",
    .about = "Deletes their passes, traces and all values derived from them, in one "
             "transaction; the segments are fused\n"
             "again from the remaining trips, and the bytes are overwritten. The result equals "
             "a database that never\n"
             "contained these trips ('macadam info --digest' proves it). A later import skips "
             "them unless --take-back is\n"
             "given; only a hash of their hash is kept for that. Pictures, exports and copies "
             "made before are not\n"
             "affected.",
    .example = "  macadam forget roads.gpkg --trip 2026-03-01-0815\n"
               "  macadam forget roads.gpkg --vehicle-id van-7 van-9",
    .operands = operands,
    .options = options,
    .run = run_forget};

} // namespace macadam
