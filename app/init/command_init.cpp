#include "app/cli/commands.hpp"
#include "app/database/key_messages.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/server_store.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/init/init_options.hpp"
#include "app/init/network_around_trips.hpp"
#include "app/init/network_update_output.hpp"

#include "estimator/common/error.hpp"
#include "mapping/conflation/network_conflation.hpp"
#include "mapping/inference/network_inference.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/networks/background/osm_background.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/networks/osm_reader.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/put_background.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/schema/store_marker.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/trip_reader.hpp"
#include "storage/uploads/sealed_log.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

namespace macadam {
namespace {

bool is_osm(const std::filesystem::path& file) {
    const auto name = file.filename().string();
    return name.find(".osm") != std::string::npos || name.ends_with(".pbf");
}

/// Derives ways from trips. Reads them one by one and keeps only their drawings.
std::vector<Way> traced_ways(const InitOptions& options, const Console& console) {
    const TraceConfig config;
    std::vector<TripDrawing> trips;
    visit_trips(options.trips, console, [&](const TripSource& trip) {
        trips.push_back(trip_drawing(read_trip(trip, needs_of_match()), config));
    });
    auto ways = trace_network(trips, config, console.progress("tracing roads"));
    if (ways.empty()) {
        throw InputError{fmt::format("no road could be traced from {} trips, expected "
                                     "positions along at least {} m, at most {} s and {} m apart",
                                     trips.size(),
                                     config.min_way_m,
                                     config.longest_gap_s,
                                     config.longest_step_m)};
    }
    return ways;
}

/// Reads the roads of a map, with --around those near trips.
std::vector<Way>
ways_of(const std::filesystem::path& map, const InitOptions& options, const Console& console) {
    if (!options.around.paths.empty()) {
        return read_network_around(options.around, map, options.columns, console);
    }
    const auto warn = [&](const std::string& words) { console.say(words); };
    return read_network(map, options.columns, console.progress("reading roads"), warn);
}

/// Tells how to make do with less if a network is far larger than a town.
void tell_of_size(const RoadNetwork& roads, const InitOptions& options, const Console& console) {
    constexpr std::size_t many_segments = 2'000'000; // 20,000 km of road in both directions
    std::size_t segments = 0;
    for (const auto edge : drivable_edges(roads)) {
        segments += link_at(roads, edge).segments;
    }
    if (segments > many_segments && options.network && options.around.paths.empty()) {
        console.say(fmt::format("{}: large map of {} segments; --around TRIPS takes only the roads "
                                "near your trips",
                                options.network->string(),
                                segments));
    }
}

void refuse_store(const std::filesystem::path& network) {
    if (network.extension() == ".gpkg" && is_store(network)) {
        throw InputError{fmt::format("{}: is a road database, expected the map from which it "
                                     "was made",
                                     network.string())};
    }
}

NetworkSource source_of(const std::filesystem::path& network, const std::string& attribution) {
    return {network.filename().string(),
            attribution.empty() && is_osm(network) ? "© OpenStreetMap contributors (ODbL)"
                                                   : attribution};
}

/// Background of a map, with `roads` read from it; null if it has none or none is wanted.
BackgroundSource background_of(const std::filesystem::path& map,
                               const RoadNetwork& roads,
                               const InitOptions& options,
                               const Console& console) {
    if (!options.background || is_server_address(options.store.string())) {
        return {}; // 'macadam copy' brings one to a server
    }
    if (!is_osm_file(map)) {
        console.say(fmt::format("{}: without water, green, buildings and names of places, which "
                                "only maps of OpenStreetMap give",
                                map.string()));
        return {};
    }
    return [&map, &console, box = background_box(roads)](const BackgroundSink& sink) {
        const auto left_out =
            read_osm_background(map, box, sink, console.progress("reading the background"));
        if (const auto count = left_out.not_closed + left_out.too_long; count > 0) {
            console.say(fmt::format(
                "{}: background without {}: rings that are open or cross, or missing points",
                map.string(),
                counted(count, "object")));
        }
        if (left_out.has_broken_coast) {
            console.warn(fmt::format("{}: background without the sea: coastlines end in the middle "
                                     "of the map, lack points or contradict each other",
                                     map.string()));
        }
    };
}

/// Reads a background into a database and states its size and time.
/// \param detail  for the audit; "" in a new database
void add_background(const std::filesystem::path& store,
                    const RoadNetwork& roads,
                    const BackgroundSource& source,
                    const std::string& detail,
                    const Console& console) {
    constexpr double bytes_per_mb = 1e6;
    const auto begin = std::chrono::steady_clock::now();
    const auto size = put_background(store, background_box(roads), source, detail);
    if (!size.is_empty()) {
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        console.say(fmt::format("{}: background of {:.1f} MB with {}, read in {:.1f} s",
                                store.string(),
                                static_cast<double>(size.bytes) / bytes_per_mb,
                                counted(static_cast<std::size_t>(size.places), "name"),
                                taken.count()));
    }
}

/// Removes a new database and new keys unless kept.
class NewDatabase {
public:
    explicit NewDatabase(std::filesystem::path store)
        : store_{std::move(store)}, had_key_{std::filesystem::exists(key_file_of(store_))} {}
    NewDatabase(const NewDatabase&) = delete;
    NewDatabase& operator=(const NewDatabase&) = delete;
    ~NewDatabase() {
        if (goes_) {
            std::error_code ignored;
            std::filesystem::remove(store_, ignored);
            if (!had_key_) {
                std::filesystem::remove(key_file_of(store_), ignored);
            }
        }
        if (!is_kept_ && !logs_key_.empty()) {
            std::error_code ignored;
            std::filesystem::remove(logs_key_, ignored);
        }
    }

    /// Takes the key of logs from its file, or makes both. \returns its public part.
    std::string public_key_in(const std::filesystem::path& file) {
        if (std::filesystem::exists(file)) {
            return read_log_key(file).public_key();
        }
        const auto key = LogKey::make();
        write_log_key(file, key);
        logs_key_ = file;
        return key.public_key();
    }

    void may_go() { goes_ = true; }
    void keep() {
        goes_ = false;
        is_kept_ = true;
    }

private:
    std::filesystem::path store_;
    std::filesystem::path logs_key_; ///< that was made
    bool had_key_;
    bool goes_ = false;
    bool is_kept_ = false;
};

void make_store(const InitOptions& options, const Console& console) {
    auto ways = options.network ? ways_of(*options.network, options, console)
                                : traced_ways(options, console);

    const auto source =
        options.network ? source_of(*options.network, options.attribution)
                        : NetworkSource{std::string{traced_network_source}, options.attribution};
    StoreSettings settings;
    settings.segment_length_m = options.segment_length_m;
    settings.network_source = source.name;
    settings.attribution = source.attribution;
    settings.privacy = options.privacy;
    settings.max_trips_per_car_month = options.max_trips_per_car_month;
    const auto roads = build_network(std::move(ways), options.segment_length_m);
    tell_of_size(roads, options, console);
    NewDatabase whole{options.store};
    if (options.keep_logs_days > 0) {
        settings.kept_logs = {.days = options.keep_logs_days,
                              .public_key = whole.public_key_in(options.logs_key)};
        warn_of_open_logs_key(options.logs_key, console);
    }
    const auto info = create_store(options.store, roads, settings, console);
    whole.may_go();
    if (const auto background = options.network
                                    ? background_of(*options.network, roads, options, console)
                                    : BackgroundSource{}) {
        add_background(options.store, roads, background, {}, console);
    }
    whole.keep();
    console.say(fmt::format("{}: {}, {}, {}, {:.1f} km counting each direction",
                            options.store.string(),
                            counted(way_count(roads), "way"),
                            counted(link_count(roads), "link"),
                            counted(info.segments, "segment"),
                            info.network_km));
}

void expect_to_go_on(const Progress& progress, const std::filesystem::path& store) {
    if (progress.stop.stop_requested()) {
        throw InputError{fmt::format("{}: interrupted; the database is unchanged", store.string())};
    }
}

void update_store(const InitOptions& options, const Console& console) {
    auto store = opened_store(options.store, console);
    const auto warn = [&](const std::string& words) { console.say(words); };
    const auto before = load_or_build_network(store, warn);
    const auto after = build_network(ways_of(*options.update, options, console),
                                     store.settings().segment_length_m);

    const auto comparing = console.progress("comparing roads");
    const auto change = change_between(before, after, {}, comparing);
    expect_to_go_on(comparing, options.store);
    const auto update =
        store.maintenance.update_network(before,
                                         after,
                                         change,
                                         source_of(*options.update, options.attribution),
                                         console.progress("moving passes"));
    cache_network(store, after);
    const auto background = background_of(*options.update, after, options, console);
    const bool is_removed = !options.background && !is_server_address(options.store.string());
    if (background || is_removed) {
        add_background(options.store,
                       after,
                       background,
                       background ? options.update->filename().string() : "removed",
                       console);
    }
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

constexpr std::array operands{Operand{
    "STORE",
    "The road database: a new .gpkg file or postgresql://...; with --update an existing one."}};

constexpr std::array options{
    Option{"--network",
           "FILE",
           "Road map: .osm.pbf, .osm, or any line layer that GDAL reads (.gpkg, .shp, "
           ".geojson, ...)."},
    around_option,
    Option{"--update",
           "FILE",
           "Update an existing database to a newer map of the same area; passes move to the "
           "matching roads."},
    Option{"--trace",
           "TRIP",
           "Without a map: trace the roads from these trips (logs, .gpx).",
           "",
           true},
    one_of("own|crowd",
           {"--privacy",
            "PROFILE",
            "own (the operator's cars, nothing is anonymised) or crowd (other people's cars).",
            "own"}),
    rare({"--keep-logs",
          "DAYS",
          "With --privacy crowd: a server keeps received logs encrypted for so long, for "
          "'macadam reprocess'."}),
    rare({"--logs-key", "FILE", "Their secret key, which is made; move it away from the server."}),
    max_members_option,
    Option{
        "--segment-length", "METRES", "Approximate length of a segment, the unit of fusion.", "20"},
    rare({"--max-trips-per-car-month",
          "K",
          "Fuse at most K trips of a car over a segment in a month; the others are kept.",
          "all"}),
    rare(in_group("line layers",
                  {"--layer", "NAME", "Line layers: name of the layer.", "the first with lines"})),
    rare(in_group("line layers",
                  {"--id-column",
                   "NAME",
                   "Line layers: column with an integer road id.",
                   "the feature's id"})),
    rare(in_group("line layers",
                  {"--name-column", "NAME", "Line layers: column with the road name."})),
    rare(in_group("line layers",
                  {"--highway-column", "NAME", "Line layers: column with the road class."})),
    rare(in_group(
        "line layers",
        {"--oneway-column", "NAME", "Line layers: column with yes, no or -1 (or FT, TF, B)."})),
    Option{
        "--attribution", "TEXT", "Copyright notice shown on maps.", "OpenStreetMap for OSM files"},
    Option{"--no-background",
           "",
           "Without water, green, built-up land, buildings, railways and places on maps."},
    Option{"--json", "", "With --update: report the changes as one JSON object."}};

} // namespace

const Command init_command{
    .name = "init",
    .summary = "Create a road database from a road network",
    .about =
        "Cuts every road into segments of about 20 m, separately for each direction in which "
        "it may be driven, and\nwrites them to a new GeoPackage. From OpenStreetMap it takes "
        "the road classes that are open to cars, and what\nmaps show below them.\n\n"
        "Road maps of OpenStreetMap are free under the ODbL, which asks to name its contributors "
        "on maps, as is done here.\nDownload one with a browser; this program never uses the "
        "internet:\n"
        "  https://download.geofabrik.de               countries and regions, .osm.pbf\n"
        "  https://extract.bbbike.org                  a rectangle or polygon up to a large city, "
        ".osm.pbf\n"
        "  https://www.openstreetmap.org/export        parts of a town, .osm\n"
        "  https://overpass-turbo.eu                   the same, somewhat larger\n"
        "A map may be far larger than needed: --around trips/ takes only the roads near your "
        "trips.",
    .example =
        "  macadam init roads.gpkg --network town.osm.pbf\n"
        "  macadam init roads.gpkg --network austria-latest.osm.pbf --around trips/\n"
        "  macadam init roads.gpkg --network roads.shp --id-column LINK_ID --oneway-column ONEWAY\n"
        "  macadam init roads.gpkg --trace trips/               no map at hand\n"
        "  macadam init roads.gpkg --update town-2027.osm.pbf   the map has changed",
    .operands = operands,
    .options = options,
    .run = run_init};

} // namespace macadam
