#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/output/units_option.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/single_trip.hpp"
#include "app/pipeline/trip_preparation.hpp"
#include "app/trace/match_output.hpp"

#include "mapping/matching/edge_traversals.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/store/schema/store_marker.hpp"
#include "storage/trips/positions/gpx_reader.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace macadam {
namespace {

struct MatchOptions {
    std::filesystem::path trip;
    std::filesystem::path network;
    std::optional<std::filesystem::path> output;
    LayerColumns columns;
    bool arcs;
    std::string format;
    UnitSystem units;
};

MatchOptions parse_match(const Arguments& arguments) {
    const auto network = arguments.value("--network");
    if (!network) {
        throw UsageError{"--network FILE is missing"};
    }
    MatchOptions options{.trip = arguments.operand("TRIP"),
                         .network = *network,
                         .output = arguments.value("--output"),
                         .columns = {.layer = arguments.value("--layer").value_or(""),
                                     .id = arguments.value("--id-column").value_or(""),
                                     .name = "",
                                     .highway = "",
                                     .oneway = arguments.value("--oneway-column").value_or("")},
                         .arcs = arguments.flag("--arcs"),
                         .format = row_format_of(arguments),
                         .units = parse_units(arguments)};
    if (options.output && !arguments.value("--format")) {
        const auto suffix = options.output->extension();
        if (suffix != ".csv" && suffix != ".json" && (suffix != ".geojson" || options.arcs)) {
            throw UsageError{fmt::format("-o is '{}', expected a name that ends in .csv, .json{}",
                                         options.output->string(),
                                         options.arcs ? "" : " or .geojson")};
        }
    }
    if (options.arcs && options.format == "geojson") {
        throw UsageError{"--arcs has no --format geojson, expected csv or json"};
    }
    return options;
}

/// Loads the network of a map, of a database made from one, or of the file beside such a database.
RoadNetwork roads_of(const MatchOptions& options, const Console& console) {
    const auto warn = [&](const std::string& words) { console.say(words); };
    if (options.network.extension() == ".gpkg" && is_store(options.network)) {
        const auto store = opened_reader(options.network, console);
        auto roads = load_or_build_network(store, warn);
        store.expect_in_place();
        return roads;
    }
    if (is_network_file(options.network)) {
        return open_network_file(options.network).roads;
    }
    return build_network(
        read_network(options.network, options.columns, console.progress("reading roads"), warn));
}

/// Prepares a trip for matching; invented times have no latency.
PreparedTrip prepared_or_untimed(TripLog trip) {
    const auto made_up = trip.meta.other.find(times_key);
    if (made_up == trip.meta.other.end()) {
        return prepared(std::move(trip));
    }
    auto words = fmt::format("its points have no increasing times; {}, so t_enter_s and "
                             "t_leave_s give the order only",
                             made_up->second);
    auto motion = motion_of(trip);
    return {std::move(trip), std::move(motion), {std::move(words)}};
}

void run_match(const Arguments& arguments, const Console& console) {
    const auto options = parse_match(arguments);
    if (options.output) {
        refuse_to_replace(*options.output,
                          {options.trip,
                           options.network,
                           arguments.value(mapping_option.name).value_or(options.trip.string())});
    }
    const auto roads = roads_of(options, console);
    const auto source =
        one_trip(options.trip, mapping_of(arguments), arguments.value("--positions").value_or(""));
    auto log = read_trip(source, needs_of_match_with_heading(), console.progress("reading"));
    const auto trip =
        with_trip_name(source.name(), [&] { return prepared_or_untimed(std::move(log)); });
    const auto trace = with_trip_name(source.name(), [&] {
        return map_match(trip.trip, trip.motion.odometer, roads, {}, trip.motion.heading).trace;
    });
    for (const auto& warning : trip.warnings) {
        console.say(warning);
    }
    console.say(matched_words(trace, trip.motion.odometer, options.units));

    const auto text =
        options.arcs
            ? arcs_text(trace, roads, options.format)
            : traversals_text(edge_traversals(trace), roads, options.format, options.units);
    RowOutput output{options.output};
    print(text);
    output.commit();
}

constexpr std::array operands{
    Operand{"TRIP", "One trip log or GPX track; positions suffice, speed improves the result."}};
constexpr std::array options{
    Option{"--network",
           "FILE",
           "The roads: .osm.pbf, .osm, a road database, its STORE-network file, or any line "
           "layer that GDAL reads."},
    mapping_option,
    positions_option,
    Option{"--arcs", "", "List every pair of consecutive nodes instead of parts of edges."},
    one_of("csv|json|geojson",
           {"--format", "NAME", "csv, json or geojson.", "by the suffix of -o; otherwise csv"}),
    Option{
        "-o,--output", "FILE", "Write a .csv, .json or .geojson file instead of standard output."},
    json_option,
    units_option,
    rare(in_group("line layers",
                  {"--layer", "NAME", "Line layers: name of the layer.", "the first with lines"})),
    rare(in_group("line layers",
                  {"--id-column",
                   "NAME",
                   "Line layers: column with an integer road id.",
                   "the feature's id"})),
    rare(in_group("line layers",
                  {"--oneway-column", "NAME", "Line layers: column with yes, no or -1."}))};

} // namespace

const Command match_command{
    .name = "match",
    .summary = "Match a trip to the road network",
    .about =
        "One row for each traversal of an edge, in driving order: from_m and to_m along the way, "
        "times, and a\n"
        "confidence from 0 to 1. Parts off the network and gaps in the positions are separate "
        "rows with their\n"
        "reason. A summary of kilometres and mean confidence goes to standard error.",
    .example = "  macadam match drive.trip.csv --network town.osm.pbf\n"
               "  macadam match drive.trip.csv --network town.osm.pbf -o match.geojson\n"
               "  macadam match drive.trip.csv --network town.osm.pbf --arcs > arcs.csv\n"
               "  macadam match tour.gpx --network roads.gpkg          a road database",
    .operands = operands,
    .options = options,
    .run = run_match};

} // namespace macadam
