#include "app/init/network_around_trips.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/trip_reader.hpp"
#include "storage/trips/trip_search.hpp"

#include <fmt/format.h>

#include <optional>

namespace macadam {
namespace {

constexpr double reach_m = 1000;

struct TripArea {
    Surroundings around{reach_m};
    std::size_t trips = 0; ///< with positions
};

TripArea area_of(const TripPaths& trips, const Console& console) {
    TripArea area;
    visit_trips(trips, console, [&](const TripSource& trip) {
        std::optional<TripLog> log;
        try {
            log = read_trip(trip, needs_of_match());
        } catch (const InputError& error) {
            console.warn(error.what());
            return;
        }
        for (const auto& fix : log->fixes) {
            area.around.add(fix.at);
        }
        area.trips += log->fixes.empty() ? 0 : 1;
    });
    if (area.around.empty()) {
        throw InputError{
            fmt::format("{}{}: contains no position, expected trips (*.trip.csv, *.gpx, "
                        "phone exports, ...) for --around",
                        trips.paths.front().string(),
                        trips.paths.size() > 1 ? " and the others" : "")};
    }
    return area;
}

GeoPoint middle_of(const GeoBox& box) {
    return {(box.south_deg + box.north_deg) / 2, (box.west_deg + box.east_deg) / 2};
}

/// Explains that a map and trips have no road in common.
std::string
no_road_text(const NetworkCut& cut, std::size_t trips, const std::filesystem::path& file) {
    const auto middle = middle_of(cut.around.box());
    return fmt::format(
        "{}: no road of this map is within {:.0f} km of {}: trips near {:.2f}, {:.2f}; map covers "
        "latitude {:.2f} to {:.2f}, longitude {:.2f} to {:.2f}; {}",
        file.string(),
        reach_m / 1000,
        counted(trips, "trip"),
        middle.lat_deg,
        middle.lon_deg,
        cut.extent.south_deg,
        cut.extent.north_deg,
        cut.extent.west_deg,
        cut.extent.east_deg,
        cut.holds_exchanged ? "are latitude and longitude exchanged in the trips or in the map?"
                            : "expected an extract of the region of the trips");
}

} // namespace

void visit_trips(const TripPaths& trips,
                 const Console& console,
                 const std::function<void(const TripSource&)>& use) {
    for (const auto& path : trips.paths) {
        TripWalk walk{path, {.tracks = true, .max_files = trips.max_members}};
        const auto reading = console.progress("reading trips");
        while (const auto trip = walk.next()) {
            if (reading.stop.stop_requested()) {
                throw InputError{"interrupted; nothing was written"};
            }
            reading(walk.given() - 1, walk.count().value_or(walk.given() + 1));
            use(*trip);
        }
        reading(1, 1);
    }
}

std::vector<Way> read_network_around(const TripPaths& trips,
                                     const std::filesystem::path& file,
                                     const LayerColumns& columns,
                                     const Console& console) {
    const auto area = area_of(trips, console);
    NetworkCut cut{.around = area.around};
    const auto warn = [&](const std::string& words) { console.say(words); };
    auto ways = read_network(file, columns, console.progress("reading roads"), warn, &cut);
    if (ways.empty()) {
        throw InputError{no_road_text(cut, area.trips, file)};
    }
    console.say(fmt::format("{}: {} of {} taken, those within {:.0f} km of {}",
                            file.string(),
                            ways.size(),
                            counted(cut.ways, "road"),
                            reach_m / 1000,
                            counted(area.trips, "trip")));
    return ways;
}

} // namespace macadam
