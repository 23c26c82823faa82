#include "app/cli/commands.hpp"
#include "app/parallel/jobs_option.hpp"
#include "app/parallel/parallel_for.hpp"
#include "app/pipeline/single_trip.hpp"
#include "app/simulate/lane_surface_cache.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/build_network.hpp"
#include "mapping/simulation/fleet.hpp"
#include "mapping/simulation/unused_rules.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/atomic/atomic_folder.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/networks/osm_writer.hpp"
#include "storage/settings/sample_scenario.hpp"
#include "storage/settings/scenario_file.hpp"
#include "storage/settings/vehicle_writer.hpp"
#include "storage/surveys/truth_file.hpp"
#include "storage/trips/log/trip_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <system_error>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t max_trips = 1'000'000;
constexpr std::size_t max_lane_bytes = std::size_t{1} << 30; // about 1,000 km
constexpr int quick_compression = 1; // more hardly shrinks noise and is slower

struct SimulateOptions {
    fs::path folder;
    fs::path network;
    std::string recipe_name;
    FleetScenario recipe;
    std::uint64_t seed;
    std::size_t jobs;
};

std::int64_t
integer_from(const Arguments& arguments, const char* name, std::int64_t fallback, Bounds range) {
    const auto value = arguments.integer(name).value_or(fallback);
    if (static_cast<double>(value) < range.low || static_cast<double>(value) > range.high) {
        throw UsageError{
            fmt::format("{} is {}, expected {:.0f} to {:.0f}", name, value, range.low, range.high)};
    }
    return value;
}

std::string needed(const Arguments& arguments, const char* name, const char* said) {
    const auto value = arguments.value(name);
    if (!value) {
        throw UsageError{fmt::format("{} is missing", said)};
    }
    return *value;
}

SimulateOptions parse_simulate(const Arguments& arguments) {
    SimulateOptions options{
        .folder = needed(arguments, "--output", "-o DIR"),
        .network = needed(arguments, "--network", "--network FILE"),
        .recipe_name = arguments.value("--recipe").value_or("the sample recipe"),
        .recipe = {},
        .seed = static_cast<std::uint64_t>(integer_from(arguments, "--seed", 1, {0, 9e15})),
        .jobs = jobs_of(arguments)};
    const auto recipe = arguments.value("--recipe");
    options.recipe = recipe ? read_recipe(*recipe) : parse_recipe("", options.recipe_name);
    const auto asked = static_cast<std::int64_t>(options.recipe.driving.trips);
    options.recipe.driving.trips =
        static_cast<std::size_t>(integer_from(arguments, "--trips", asked, {1, double{max_trips}}));
    return options;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        throw InputError{
            fmt::format("{}: cannot create the folder: {}", folder.string(), error.message())};
    }
}

void write_file(const fs::path& file, std::string_view text) {
    AtomicFile out{file};
    out.write(text);
    out.commit();
}

void stop_if_wanted(const Console& console) {
    if (console.stop().stop_requested()) {
        throw InputError{"interrupted: nothing was written"};
    }
}

/// Returns the network as read back from network.osm.pbf, with positions on that format's grid.
RoadNetwork
written_network(const fs::path& network, const fs::path& folder, const Console& console) {
    const auto file = folder / "network.osm.pbf";
    const auto given =
        copies_of_ways(build_network(read_network(network, {}, console.progress("reading roads"))));
    with_trip_name(network.string(), [&] { expect_osm(given); });
    write_osm(given, file);
    return build_network(read_network(file));
}

/// Writes a header and the rows of all lanes.
void write_lanes(const fs::path& file,
                 std::string_view header,
                 const std::vector<std::string>& lanes) {
    AtomicFile out{file};
    out.write(std::string{header} + "\n");
    for (const auto& rows : lanes) {
        out.write(rows);
    }
    out.commit();
}

void write_truth(const Fleet& fleet,
                 const RoadNetwork& roads,
                 LaneSurfaceCache& surfaces,
                 const fs::path& folder,
                 std::size_t jobs,
                 const Console& console) {
    const auto lanes = drivable_lanes(roads);
    std::vector<std::string> rows(lanes.size());
    std::vector<std::string> potholes(lanes.size());
    parallel_for(
        lanes.size(),
        jobs,
        [&](std::size_t i) {
            const auto surface = surfaces(lanes[i]);
            rows[i] = truth_rows(lane_truth(roads, lanes[i], *surface));
            potholes[i] = pothole_truth_rows(
                lane_potholes(fleet.recipe, roads, lanes[i], *surface, fleet.seed));
        },
        console.progress("generating surfaces"));
    stop_if_wanted(console);
    write_lanes(folder / "truth.csv", truth_header, rows);
    write_lanes(folder / "truth-potholes.csv", pothole_truth_header, potholes);
}

/// Writes the vehicle files with their errors, and beside them those of the true cars.
void write_vehicles(const Fleet& fleet, const fs::path& folder) {
    make_folder(folder / "vehicles");
    make_folder(folder / "truth-vehicles");
    for (const auto& car : fleet.cars) {
        const auto name = car.written.name + ".toml";
        write_file(folder / "vehicles" / name,
                   "# Written by 'macadam simulate': the true car, as wrong as the recipe says.\n" +
                       vehicle_text(car.written));
        write_file(folder / "truth-vehicles" / name,
                   "# Written by 'macadam simulate': the true car.\n" + vehicle_text(car.truth));
    }
}

double driven_km(const TripLog& trip) {
    double sum_m = 0;
    for (std::size_t i = 1; i < trip.fixes.size(); ++i) {
        sum_m += distance_m(trip.fixes[i - 1].at, trip.fixes[i].at);
    }
    return sum_m / 1000;
}

/// Writes all trips.
/// \returns  km driven
double write_trips(const Fleet& fleet,
                   const RoadNetwork& roads,
                   LaneSurfaceCache& surfaces,
                   const fs::path& folder,
                   std::size_t jobs,
                   const Console& console) {
    make_folder(folder);
    std::vector<double> km(fleet.recipe.driving.trips);
    parallel_for(
        km.size(),
        jobs,
        [&](std::size_t number) {
            const auto trip = simulate_trip(fleet, roads, std::ref(surfaces), number);
            km[number] = driven_km(trip);
            write_trip(trip, folder / (trip.meta.trip_id + ".trip.csv.gz"), quick_compression);
        },
        console.progress("driving"));
    stop_if_wanted(console);
    return std::accumulate(km.begin(), km.end(), 0.0);
}

struct SimulatedFiles {
    std::size_t trips;
    std::size_t cars;
    std::size_t roads;
    double km;
};

SimulatedFiles
simulated(const SimulateOptions& options, const fs::path& folder, const Console& console) {
    const auto roads = written_network(options.network, folder, console);
    stop_if_wanted(console);
    for (const auto& words : unused_rules(options.recipe, roads)) {
        console.warn(fmt::format("{}: {}", options.recipe_name, words));
    }
    const auto fleet = with_trip_name(
        options.network.string(), [&] { return make_fleet(options.recipe, roads, options.seed); });
    write_vehicles(fleet, folder);
    LaneSurfaceCache surfaces{
        [&](const Lane& lane) { return lane_surface(fleet.recipe, roads, lane, fleet.seed); },
        max_lane_bytes};
    write_truth(fleet, roads, surfaces, folder, options.jobs, console);
    const double km = write_trips(fleet, roads, surfaces, folder / "trips", options.jobs, console);
    return {fleet.recipe.driving.trips, fleet.cars.size(), way_count(roads), km};
}

void run_simulate(const Arguments& arguments, const Console& console) {
    if (arguments.flag("--show-recipe")) {
        print(sample_recipe());
        return;
    }
    const auto options = parse_simulate(arguments);
    AtomicFolder folder{options.folder};
    const auto made = simulated(options, folder.temporary(), console);
    folder.commit();
    console.say(fmt::format("{}: {} by {}, {:.0f} km, over {}",
                            options.folder.string(),
                            counted(made.trips, "trip"),
                            counted(made.cars, "car"),
                            made.km,
                            counted(made.roads, "road")));
}

constexpr std::array options{
    Option{"-o,--output", "DIR", "Output folder: new or empty."},
    Option{"--network",
           "FILE",
           "Road map: .osm.pbf, .osm, or any line layer that GDAL reads (.gpkg, .geojson, ...)."},
    Option{"--recipe",
           "FILE.toml",
           "Scenario file: cars, roads, trips, sensors.",
           "the sample recipe"},
    Option{"--show-recipe", "", "Print the sample recipe, with a comment on every key."},
    Option{"--seed", "N", "Random seed: each number gives another fleet on other roads.", "1"},
    Option{"--trips", "N", "Number of trips, overrides the recipe."},
    preference({"--jobs",
                "N",
                "Number of parallel jobs; the files do not depend on it.",
                default_jobs_words})};

} // namespace

const Command simulate_command{
    .name = "simulate",
    .summary = "Simulate trips of known cars over known roads, with the true IRI",
    .about = "Gives every way of the network a surface in each direction, drives cars with two "
             "axles, dampers, friction\n"
             "and tyres over it and writes what their sensors would log: DIR/trips/, "
             "DIR/vehicles/,\n"
             "DIR/network.osm.pbf, DIR/truth.csv with the true IRI of every segment,\n"
             "DIR/truth-potholes.csv with the potholes that the recipe asked for, and\n"
             "DIR/truth-vehicles/ with the true cars; DIR/vehicles/ has the errors that the recipe "
             "states.\n"
             "The same network, recipe and seed give the same bytes on every machine.",
    .example = "  macadam simulate -o fleet --network town.osm.pbf\n"
               "  macadam simulate --show-recipe > mine.toml            a recipe to start "
               "from\n"
               "  macadam simulate -o year --network town.osm.pbf --recipe mine.toml --trips "
               "1000 --jobs 8\n"
               "How accurate is the map?\n"
               "  macadam init fleet/roads.gpkg --network fleet/network.osm.pbf\n"
               "  macadam import fleet/roads.gpkg fleet/trips\n"
               "  macadam info fleet/roads.gpkg --truth fleet/truth.csv",
    .operands = {},
    .options = options,
    .run = run_simulate};

} // namespace macadam
