#include "app/commands.hpp"
#include "app/output_guard.hpp"

#include "estimator/common/error.hpp"
#include "mapping/trace_network.hpp"
#include "storage/network_file.hpp"
#include "storage/network_reader.hpp"
#include "storage/road_store.hpp"
#include "storage/trip_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

namespace macadam {
namespace {

constexpr double least_segment_m = 5;
constexpr double most_segment_m = 1000;

struct InitOptions {
    std::filesystem::path store;
    std::optional<std::filesystem::path> network;
    std::vector<std::filesystem::path> trips; ///< to trace a network from
    LayerColumns columns;
    std::string attribution;
    double segment_length_m;
};

InitOptions parse_init(const Arguments& arguments) {
    InitOptions options;
    options.store = arguments.operand("STORE");
    if (options.store.extension() != ".gpkg") {
        throw UsageError{fmt::format("STORE is '{}', expected a name that ends in .gpkg",
                                     options.store.string())};
    }
    options.network = arguments.value("--network");
    const auto trips = arguments.values("--trace");
    options.trips.assign(trips.begin(), trips.end());
    if (options.network.has_value() == !trips.empty()) {
        throw UsageError{"expected either --network FILE or --trace TRIP..."};
    }
    options.segment_length_m = arguments.number("--segment-length", RoadNetwork{}.segment_length_m);
    if (!(options.segment_length_m >= least_segment_m &&
          options.segment_length_m <= most_segment_m)) {
        throw UsageError{fmt::format("--segment-length is {}, expected {} to {} metres",
                                     options.segment_length_m,
                                     least_segment_m,
                                     most_segment_m)};
    }
    options.columns = {.layer = arguments.value("--layer").value_or(""),
                       .id = arguments.value("--id-column").value_or(""),
                       .name = arguments.value("--name-column").value_or(""),
                       .highway = arguments.value("--highway-column").value_or(""),
                       .oneway = arguments.value("--oneway-column").value_or("")};
    options.attribution = arguments.value("--attribution").value_or("");
    return options;
}

bool is_osm(const std::filesystem::path& file) {
    const auto name = file.filename().string();
    return name.find(".osm") != std::string::npos || name.ends_with(".pbf");
}

/// Trips are read one by one, and only what they drew is kept.
std::vector<Way> traced_ways(const std::vector<std::filesystem::path>& paths,
                             const Console& console) {
    const TraceConfig config;
    std::vector<TripDrawing> trips;
    for (const auto& path : paths) {
        const auto found = find_tracks(path).trips;
        const auto reading = console.progress("reading trips");
        for (std::size_t i = 0; i < found.size(); ++i) {
            reading(i, found.size());
            trips.push_back(trip_drawing(read_trip(found[i], needs_of_match()), config));
        }
        reading(found.size(), found.size());
    }
    auto ways = trace_network(trips, config, console.progress("drawing roads"));
    if (ways.empty()) {
        throw InputError{fmt::format("{} trips drew no road, expected positions along at least {} "
                                     "m, at most {} s apart",
                                     trips.size(),
                                     config.least_way_m,
                                     config.longest_gap_s)};
    }
    return ways;
}

void run_init(const Arguments& arguments, const Console& console) {
    const auto options = parse_init(arguments);
    if (options.network && options.network->extension() == ".gpkg" && is_store(*options.network)) {
        throw InputError{fmt::format("{}: is a store, expected the map that it was made from",
                                     options.network->string())};
    }
    auto ways =
        options.network
            ? read_network(*options.network, options.columns, console.progress("reading roads"))
            : traced_ways(options.trips, console);

    StoreSettings settings;
    settings.segment_length_m = options.segment_length_m;
    settings.network_source = options.network ? options.network->filename().string()
                                              : std::string{"traced from the trips"};
    settings.attribution = options.attribution;
    if (settings.attribution.empty() && options.network && is_osm(*options.network)) {
        settings.attribution = "© OpenStreetMap contributors (ODbL)";
    }
    const auto roads = build_network(std::move(ways), options.segment_length_m);
    const auto store =
        RoadStore::create(options.store, roads, settings, console.progress("writing segments"));

    keep_roads(store, roads);

    const auto info = store.info();
    console.say(fmt::format("{}: {}, {}, {}, {:.1f} km counting each direction",
                            options.store.string(),
                            counted(way_count(roads), "way"),
                            counted(link_count(roads), "link"),
                            counted(info.segments, "segment"),
                            info.network_km));
}

constexpr std::array operands{
    Operand{"STORE", "The store to make, a .gpkg file that does not exist yet."}};

constexpr std::array options{
    Option{"--network",
           "FILE",
           "The roads: .osm.pbf, .osm, or any line layer that GDAL reads (.gpkg, .shp, .geojson, "
           "...)."},
    Option{"--trace",
           "TRIP",
           "Where there is no map: draw the roads from these trips (logs, .gpx).",
           "",
           true},
    Option{"--segment-length", "METRES", "About how long a segment is, the unit of fusion.", "20"},
    Option{"--layer", "NAME", "Of a line layer file: which layer.", "the first with lines"},
    Option{"--id-column",
           "NAME",
           "Of a line layer: the column with a whole-number road id.",
           "the feature's id"},
    Option{"--name-column", "NAME", "Of a line layer: the column with the road's name."},
    Option{"--highway-column", "NAME", "Of a line layer: the column with the road's class."},
    Option{"--oneway-column",
           "NAME",
           "Of a line layer: the column that says yes, no or -1 (or FT, TF, B)."},
    Option{"--attribution",
           "TEXT",
           "Whom pictures of these roads must name.",
           "OpenStreetMap for OSM files"}};

} // namespace

const Command init_command{
    .name = "init",
    .summary = "Make a store from a road network",
    .about =
        "Cuts every road into segments of about 20 m, one set for each direction that may be "
        "driven, and\n"
        "lays them into a new GeoPackage. Of OpenStreetMap it takes the classes that cars may use.",
    .example =
        "  macadam init roads.gpkg --network town.osm.pbf\n"
        "  macadam init roads.gpkg --network roads.shp --id-column LINK_ID --oneway-column ONEWAY\n"
        "  macadam init roads.gpkg --trace trips/               no map at hand",
    .operands = operands,
    .options = options,
    .run = run_init};

} // namespace macadam
