#include "app/commands.hpp"
#include "app/segment_options.hpp"
#include "app/store_patience.hpp"

#include "storage/json.hpp"

#include <fmt/format.h>

#include <array>

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

void run_forget(const Arguments& arguments, const Console& console) {
    const auto file = store_file(arguments);
    const ForgetRequest request{.trips = arguments.values("--trip"),
                                .vehicles = arguments.values("--vehicle")};
    if (request.trips.empty() && request.vehicles.empty()) {
        throw UsageError{"expected --trip or --vehicle: whom to forget"};
    }
    auto store = opened_store(file, RoadStore::Access::write, console);
    const auto progress = console.progress("forgetting");
    const auto forgotten = store.forget(request, progress);
    if (arguments.flag("--json")) {
        print(json_of(forgotten));
    } else {
        print_words(
            fmt::format("{} forgotten: {} over {}{}\n",
                        counted(forgotten.trips, "trip"),
                        counted(forgotten.passes, "pass"),
                        counted(forgotten.segments, "segment"),
                        forgotten.calibrated ? "; the cars were calibrated anew without" : ""));
    }
    if (!forgotten.log_is_clean) {
        console.warn(fmt::format("{}-wal: others read the store, so its log still holds what was "
                                 "forgotten, until the last of them closes it",
                                 file.string()));
    }
}

constexpr std::array operands{store_operand};
constexpr std::array options{
    Option{"--trip",
           "TRIP",
           "Trips by trip_id, name of the file, or SHA-256 of the content.",
           "",
           true},
    Option{"--vehicle",
           "ID",
           "All trips of these cars, by vehicle_id or by pseudonym ('macadam info').",
           "",
           true},
    Option{"--json", "", "What was done as one JSON object."}};

} // namespace

const Command forget_command{
    .name = "forget",
    .summary = "Take trips or cars out of a store, to the last byte",
    .about = "Passes, traces and all numbers that came of them go, in one transaction; the numbers "
             "of the segments are\nmade anew from the other trips, and bytes are overwritten. What "
             "is left is what a store holds that never\nsaw these trips ('macadam info --digest' "
             "shows it). A later import of such a trip is 'known' and leaves it\nout, unless "
             "--take-back lets it in; a hash of its hash is kept for that. Pictures, exports and "
             "copies that\nwere made before are beyond reach.",
    .example = "  macadam forget roads.gpkg --trip 2026-03-01-0815\n"
               "  macadam forget roads.gpkg --vehicle van-7 van-9",
    .operands = operands,
    .options = options,
    .run = run_forget};

} // namespace macadam
