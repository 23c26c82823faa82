#include "app/asked_trips.hpp"
#include "app/commands.hpp"
#include "app/network_update_output.hpp"
#include "app/output_guard.hpp"
#include "app/store_patience.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network_change.hpp"
#include "mapping/trace_network.hpp"
#include "storage/network_file.hpp"
#include "storage/network_reader.hpp"
#include "storage/road_store.hpp"
#include "storage/text.hpp"
#include "storage/trip_reader.hpp"
#include "storage/trip_walk.hpp"

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
    std::optional<std::filesystem::path> update; ///< a newer network for a store that is there
    std::vector<std::filesystem::path> trips;    ///< to trace a network from
    LayerColumns columns;
    std::string attribution;
    double segment_length_m;
    PrivacyProfile privacy;
    std::size_t max_members; ///< of an archive of trips
    bool json;
};

PrivacyProfile privacy_in(const Arguments& arguments) {
    const auto name = arguments.value("--privacy").value_or("own");
    const auto profile = privacy_profile_named(name);
    if (!profile) {
        throw UsageError{fmt::format("--privacy is {}, expected own or crowd", in_quotes(name))};
    }
    return *profile;
}

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
    options.update = arguments.value("--update");
    const int sources = (options.network ? 1 : 0) + (options.update ? 1 : 0) + !trips.empty();
    if (sources != 1) {
        throw UsageError{"expected either --network FILE, --trace TRIP... or --update FILE"};
    }
    options.json = arguments.flag("--json");
    if (options.json && !options.update) {
        throw UsageError{"--json is only for --update, which reports what has become of the roads"};
    }
    if (options.update && arguments.number("--segment-length")) {
        throw UsageError{"--segment-length cannot be changed by --update: the store's stays"};
    }
    if (options.update && arguments.value("--privacy")) {
        throw UsageError{"--privacy cannot be changed by --update: the store's stays"};
    }
    options.privacy = privacy_in(arguments);
    if (options.privacy == PrivacyProfile::crowd && !trips.empty()) {
        throw UsageError{
            "--trace does not go with --privacy crowd: roads drawn from trips end where "
            "these did; expected --network"};
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
    options.max_members = max_members_of(arguments);
    return options;
}

bool is_osm(const std::filesystem::path& file) {
    const auto name = file.filename().string();
    return name.find(".osm") != std::string::npos || name.ends_with(".pbf");
}

/// Trips are read one by one, and only what they drew is kept.
std::vector<Way> traced_ways(const InitOptions& options, const Console& console) {
    const TraceConfig config;
    std::vector<TripDrawing> trips;
    for (const auto& path : options.trips) {
        TripWalk walk{path, {.tracks = true, .most_files = options.max_members}};
        const auto reading = console.progress("reading trips");
        while (const auto trip = walk.next()) {
            reading(walk.given() - 1, walk.count().value_or(walk.given() + 1));
            trips.push_back(trip_drawing(read_trip(*trip, needs_of_match()), config));
        }
        reading(1, 1);
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

void refuse_store(const std::filesystem::path& network) {
    if (network.extension() == ".gpkg" && is_store(network)) {
        throw InputError{fmt::format("{}: is a store, expected the map that it was made from",
                                     network.string())};
    }
}

NetworkSource source_of(const std::filesystem::path& network, const std::string& attribution) {
    return {network.filename().string(),
            attribution.empty() && is_osm(network) ? "© OpenStreetMap contributors (ODbL)"
                                                   : attribution};
}

void make_store(const InitOptions& options, const Console& console) {
    const auto warn = [&](const std::string& words) { console.say(words); };
    auto ways =
        options.network
            ? read_network(
                  *options.network, options.columns, console.progress("reading roads"), warn)
            : traced_ways(options, console);

    const auto source =
        options.network ? source_of(*options.network, options.attribution)
                        : NetworkSource{std::string{traced_network_source}, options.attribution};
    StoreSettings settings;
    settings.segment_length_m = options.segment_length_m;
    settings.network_source = source.name;
    settings.attribution = source.attribution;
    settings.privacy = options.privacy;
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

void expect_to_go_on(const Progress& progress, const std::filesystem::path& store) {
    if (progress.stop.stop_requested()) {
        throw InputError{fmt::format("{}: interrupted; the store is as it was", store.string())};
    }
}

void update_store(const InitOptions& options, const Console& console) {
    auto store = opened_store(options.store, RoadStore::Access::write, console);
    const auto warn = [&](const std::string& words) { console.say(words); };
    const auto before = kept_roads(store, warn);
    const auto after = build_network(
        read_network(*options.update, options.columns, console.progress("reading roads"), warn),
        store.settings().segment_length_m);

    const auto comparing = console.progress("comparing roads");
    const auto change = change_between(before, after, {}, comparing);
    expect_to_go_on(comparing, options.store);
    const auto update = store.update_network(before,
                                             after,
                                             change,
                                             source_of(*options.update, options.attribution),
                                             console.progress("carrying passes"));
    keep_roads(store, after);
    if (options.json) {
        print(json_of(update));
    } else {
        print_words(text_of(update));
    }
}

void run_init(const Arguments& arguments, const Console& console) {
    const auto options = parse_init(arguments);
    if (const auto& network = options.update ? options.update : options.network) {
        refuse_store(*network);
    }
    if (options.update) {
        update_store(options, console);
    } else {
        make_store(options, console);
    }
}

constexpr std::array operands{
    Operand{"STORE",
            "The store to make, a .gpkg file that does not exist yet; with --update one that "
            "does."}};

constexpr std::array options{
    Option{"--network",
           "FILE",
           "The roads: .osm.pbf, .osm, or any line layer that GDAL reads (.gpkg, .shp, .geojson, "
           "...)."},
    Option{"--update",
           "FILE",
           "A newer map of the same area for a store that is there: passes go to where its roads "
           "are the same."},
    Option{"--trace",
           "TRIP",
           "Where there is no map: draw the roads from these trips (logs, .gpx).",
           "",
           true},
    Option{
        "--privacy",
        "PROFILE",
        "Whose cars it is for: own (one's own: nothing is anonymised) or crowd (cars of others).",
        "own"},
    max_members_option,
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
           "OpenStreetMap for OSM files"},
    Option{
        "--json", "", "With --update: what has become of roads and passes, as one JSON object."}};

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
        "  macadam init roads.gpkg --trace trips/               no map at hand\n"
        "  macadam init roads.gpkg --update town-2027.osm.pbf   the map has changed",
    .operands = operands,
    .options = options,
    .run = run_init};

} // namespace macadam
