#include "app/init/init_options.hpp"

#include "app/database/server_store.hpp"
#include "app/import/trip_inputs.hpp"
#include "estimator/common/error.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <string_view>

namespace macadam {
namespace {

constexpr double min_segment_m = 5;
constexpr double max_segment_m = 1000;
constexpr std::int64_t max_trip_limit = 1000;

PrivacyProfile privacy_in(const Arguments& arguments) {
    const auto name = arguments.value("--privacy").value_or("own");
    const auto profile = privacy_profile_named(name);
    if (!profile) {
        throw UsageError{fmt::format("--privacy is {}, expected own or crowd", in_quotes(name))};
    }
    return *profile;
}

std::int64_t trip_limit_in(const Arguments& arguments, const InitOptions& options) {
    const auto limit = arguments.integer("--max-trips-per-car-month");
    if (limit && options.update) {
        throw UsageError{"--max-trips-per-car-month cannot be changed by --update"};
    }
    if (limit && (*limit < 1 || *limit > max_trip_limit)) {
        throw UsageError{fmt::format(
            "--max-trips-per-car-month is {}, expected 1 to {}", *limit, max_trip_limit)};
    }
    return limit.value_or(0);
}

/// Parses --keep-logs and --logs-key.
void parse_kept_logs(const Arguments& arguments, InitOptions& options) {
    const auto days = arguments.integer("--keep-logs");
    const auto key = arguments.value("--logs-key");
    if (!days && !key) {
        return;
    }
    if (!days || !key) {
        throw UsageError{"expected --keep-logs DAYS and --logs-key FILE together"};
    }
    if (*days < 1 || *days > max_kept_logs_days) {
        throw UsageError{
            fmt::format("--keep-logs is {}, expected 1 to {} days", *days, max_kept_logs_days)};
    }
    if (options.privacy != PrivacyProfile::crowd || options.update) {
        throw UsageError{"--keep-logs is for a new database with --privacy crowd: keep the logs of "
                         "your own cars yourself"};
    }
    options.keep_logs_days = *days;
    options.logs_key = *key;
}

TripPaths trips_in(const Arguments& arguments, std::string_view option) {
    const auto paths = arguments.values(option);
    return {{paths.begin(), paths.end()}, max_members_of(arguments)};
}

} // namespace

InitOptions parse_init(const Arguments& arguments) {
    InitOptions options;
    options.store = file_or_server(arguments);
    const bool is_on_server = is_server_address(options.store.string());
    if (!is_on_server && options.store.extension() != ".gpkg") {
        throw UsageError{fmt::format("STORE is '{}', expected a name that ends in .gpkg",
                                     options.store.string())};
    }
    options.network = arguments.value("--network");
    options.trips = trips_in(arguments, "--trace");
    options.around = trips_in(arguments, "--around");
    options.update = arguments.value("--update");
    const bool is_traced = !options.trips.paths.empty();
    const int sources = (options.network ? 1 : 0) + (options.update ? 1 : 0) + is_traced;
    if (sources != 1) {
        throw UsageError{"expected either --network FILE, --trace TRIP... or --update FILE; where "
                         "to get a FILE of roads: macadam help init"};
    }
    if (is_traced && !options.around.paths.empty()) {
        throw UsageError{"--around cannot be combined with --trace: there is no map to cut"};
    }
    if (options.update && !options.around.paths.empty()) {
        throw UsageError{
            "--around cannot be combined with --update: roads away from these trips would be "
            "removed with their passes; expected --update with a map of the whole area"};
    }
    options.json = arguments.flag("--json");
    if (options.json && !options.update) {
        throw UsageError{"--json requires --update, which reports the changes of the roads"};
    }
    if (options.update && arguments.number("--segment-length")) {
        throw UsageError{"--segment-length cannot be changed by --update"};
    }
    if (options.update && arguments.value("--privacy")) {
        throw UsageError{"--privacy cannot be changed by --update"};
    }
    options.privacy = privacy_in(arguments);
    options.max_trips_per_car_month = trip_limit_in(arguments, options);
    parse_kept_logs(arguments, options);
    if (options.keep_logs_days > 0 && is_on_server) {
        throw UsageError{"--keep-logs is for a .gpkg file: workers of a database on a server erase "
                         "the logs of a crowd"};
    }
    if (options.privacy == PrivacyProfile::crowd && is_traced) {
        throw UsageError{
            "--trace cannot be combined with --privacy crowd: roads traced from trips end "
            "where the trips end; expected --network"};
    }
    if (options.privacy == PrivacyProfile::crowd && !options.around.paths.empty()) {
        throw UsageError{
            "--around cannot be combined with --privacy crowd: the outline of the roads would "
            "show where the trips went; expected a map of the whole area"};
    }
    options.segment_length_m = arguments.number("--segment-length", RoadNetwork{}.segment_length_m);
    if (!(options.segment_length_m >= min_segment_m && options.segment_length_m <= max_segment_m)) {
        throw UsageError{fmt::format("--segment-length is {}, expected {} to {} metres",
                                     options.segment_length_m,
                                     min_segment_m,
                                     max_segment_m)};
    }
    options.columns = {.layer = arguments.value("--layer").value_or(""),
                       .id = arguments.value("--id-column").value_or(""),
                       .name = arguments.value("--name-column").value_or(""),
                       .highway = arguments.value("--highway-column").value_or(""),
                       .oneway = arguments.value("--oneway-column").value_or("")};
    options.attribution = arguments.value("--attribution").value_or("");
    options.background = !arguments.flag("--no-background");
    if (!options.background && is_traced) {
        throw UsageError{"--no-background cannot be combined with --trace: trips have none"};
    }
    return options;
}

} // namespace macadam
