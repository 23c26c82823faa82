// What matching costs on a network of millions of edges: the same trips on one copy of some roads
// and on many copies side by side, long trips, and the plain method of Newson and Krumm.

#include "bench/match/newson_krumm.hpp"
#include "estimator/common/error.hpp"
#include "goal.hpp"
#include "mapping/network/build_network.hpp"
#include "simulated_world.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/networks/network_reader.hpp"

#include <fmt/format.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::bench {
namespace {

constexpr std::string_view usage =
    "usage: large_network [--arcs N] NETWORKS...\n"
    "\n"
    "Puts copies of road networks (.osm.pbf files, or folders of them) side by side until they "
    "have\n"
    "N directed node-to-node edges (5000000), opens each as a mapped file, matches simulated trips "
    "on one copy, on ten and on "
    "all,\n"
    "and says how many positions a second of CPU time it did. Prints Markdown.\n";

constexpr double copy_lon_deg = 0.5; // no network is as wide, and no two lie as far north
constexpr std::int64_t copy_ids = std::int64_t{1} << 40; // beyond the ids of OSM
constexpr int turns = 5;
constexpr std::size_t drives_each = 2;
constexpr std::size_t ten = 10;
constexpr double hour_s = 3600;

struct Options {
    std::vector<std::filesystem::path> files;
    std::size_t arcs = 5'000'000;
};

Options parsed(const std::vector<std::string>& words) {
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--arcs" && i + 1 < words.size()) {
            const auto& word = words[++i];
            const auto end = word.data() + word.size();
            if (std::from_chars(word.data(), end, options.arcs).ptr != end) {
                throw InputError{fmt::format("--arcs is '{}', expected a whole number", word)};
            }
        } else if (std::filesystem::is_directory(words[i])) {
            const auto files = networks_in(words[i]);
            options.files.insert(options.files.end(), files.begin(), files.end());
        } else {
            options.files.emplace_back(words[i]);
        }
    }
    if (options.files.empty()) {
        throw InputError{"no network was named"};
    }
    return options;
}

std::size_t arcs_in(const std::vector<Way>& ways) {
    std::size_t arcs = 0;
    for (const auto& way : ways) {
        arcs += (way.line.size() - 1) * (way.oneway == Oneway::no ? 2 : 1);
    }
    return arcs;
}

Way renumbered(Way way, std::int64_t shift) {
    way.id += shift;
    for (auto& id : way.node_ids) {
        id += shift;
    }
    for (auto& turn : way.turns) {
        turn.via_node += shift;
        turn.to_way += shift;
    }
    return way;
}

/// All networks of the files as one; ways of different files have ids of their own.
std::vector<Way> ways_of(const std::vector<std::filesystem::path>& files) {
    constexpr std::int64_t file_ids = std::int64_t{1} << 36;
    std::vector<Way> ways;
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (auto& way : read_network(files[i])) {
            ways.push_back(renumbered(std::move(way), static_cast<std::int64_t>(i) * file_ids));
        }
    }
    return ways;
}

/// So many copies side by side: to the east, and on from the west.
std::vector<Way> copies_of(const std::vector<Way>& ways, std::size_t copies) {
    std::vector<Way> all;
    all.reserve(copies * ways.size());
    for (std::size_t k = 0; k < copies; ++k) {
        for (auto way : ways) {
            way = renumbered(std::move(way), static_cast<std::int64_t>(k) * copy_ids);
            for (auto& place : way.line) {
                place.lon_deg += static_cast<double>(k) * copy_lon_deg;
            }
            all.push_back(std::move(way));
        }
    }
    return all;
}

double cpu_s() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double seconds_of(const std::function<void()>& work) {
    const double begin_s = cpu_s();
    work();
    return cpu_s() - begin_s;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

/// Each piece of work turn by turn, so that what else runs on the machine meets all alike.
std::vector<double> medians_s(const std::vector<std::function<void()>>& works) {
    std::vector<std::vector<double>> took_s(works.size());
    for (int turn = 0; turn < turns; ++turn) {
        for (std::size_t i = 0; i < works.size(); ++i) {
            took_s[i].push_back(seconds_of(works[i]));
        }
    }
    std::vector<double> middle_s(works.size());
    std::ranges::transform(took_s, middle_s.begin(), median);
    return middle_s;
}

double peak_mb() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_maxrss) / 1024;
}

std::size_t positions_in(const std::vector<TripLog>& trips) {
    std::size_t positions = 0;
    for (const auto& trip : trips) {
        positions += trip.fixes.size();
    }
    return positions;
}

std::vector<TripLog> trips_on(const std::vector<std::filesystem::path>& files) {
    std::vector<TripLog> trips;
    for (const auto& file : files) {
        const auto network = driven_network(file, drives_each, 1);
        for (std::size_t i = 0; i < drives_each; ++i) {
            trips.push_back(recorded(network, i, Scenario{}).trip);
        }
    }
    return trips;
}

/// A trip of an hour, ten positions a second, all sensors.
TripLog hour_long(const std::filesystem::path& file) {
    const auto roads = build_network(read_network(file));
    auto recipe = recipe_of({.fix_rate_hz = 10, .sensors = with_all});
    recipe.driving.length_km = {90, 90};
    const auto map = make_route_map(roads, recipe.driving, 1);
    auto trip = recorded(make_drive(roads, map, recipe.driving, 1, 0), recipe, with_all, 1).trip;
    std::erase_if(trip.fixes, [](const GnssFix& fix) { return fix.t_s > hour_s; });
    const auto cut = [](std::vector<double>& t_s) {
        t_s.resize(static_cast<std::size_t>(std::ranges::upper_bound(t_s, hour_s) - t_s.begin()));
        return t_s.size();
    };
    trip.speed.speed_mps.resize(cut(trip.speed.t_s));
    const auto rates = cut(trip.gyro.t_s);
    trip.gyro.x.resize(rates);
    trip.gyro.y.resize(rates);
    trip.gyro.z.resize(rates);
    return trip;
}

/// Each so many-th position of the first so many seconds, and nothing else.
TripLog positions_of(const TripLog& trip, std::size_t each, double until_s) {
    TripLog some;
    some.meta = trip.meta;
    for (std::size_t i = 0; i < trip.fixes.size() && trip.fixes[i].t_s <= until_s; i += each) {
        auto fix = trip.fixes[i];
        fix.speed_mps = std::numeric_limits<float>::quiet_NaN();
        fix.course_deg = fix.speed_mps;
        some.fixes.push_back(fix);
    }
    return some;
}

struct Sized {
    std::size_t copies;
    std::size_t arcs;
    double build_s;
    RoadNetwork roads;
};

/// As users have them: in a file that is mapped. It needs no name once it is open.
RoadNetwork mapped(const RoadNetwork& roads) {
    const auto file =
        std::filesystem::temp_directory_path() / fmt::format("macadam_large_network_{}", getpid());
    write_network_file(roads, std::string(64, '0'), file);
    auto opened = open_network_file(file).roads;
    std::filesystem::remove(file);
    return opened;
}

Sized sized(const std::vector<Way>& ways, std::size_t copies) {
    Sized network{.copies = copies, .arcs = copies * arcs_in(ways), .build_s = 0, .roads = {}};
    auto all = copies_of(ways, copies);
    RoadNetwork built;
    network.build_s = seconds_of([&] { built = build_network(std::move(all)); });
    network.roads = mapped(built);
    return network;
}

void match_all(const std::vector<TripLog>& trips, const RoadNetwork& roads) {
    for (const auto& trip : trips) {
        matched(trip, roads);
    }
}

void print_growth(const std::vector<Sized>& networks, const std::vector<TripLog>& trips) {
    std::vector<std::function<void()>> works;
    works.reserve(networks.size());
    for (const auto& network : networks) {
        works.emplace_back([&] { match_all(trips, network.roads); });
    }
    const auto took_s = medians_s(works);
    const auto positions = static_cast<double>(positions_in(trips));
    const double plain_s = seconds_of([&] {
        for (const auto& trip : trips) {
            newson_krumm(trip, networks.front().roads);
        }
    });

    print_goal(
        {"positions/s on a network of 5 million directed node-to-node edges, 1 Hz, positions",
         ">= 150,000",
         fmt::format("{:.0f}", positions / took_s.back()),
         fmt::format("{:.0f} on one copy", positions / plain_s)});
    print_goal({"CPU time on ten times the edges, over that on one copy",
                "<= 1.3",
                fmt::format("{:.2f}", took_s[1] / took_s[0]),
                ""});
    fmt::print(
        "### Growth with the network\n\n"
        "{} trips, {:.0f} positions, one a second, nothing else; median of {} turns.\n\n"
        "| copies | directed node-to-node edges | built in CPU s | positions/s | CPU, times that "
        "on one copy |\n|---|---|---|---|---|\n",
        trips.size(),
        positions,
        turns);
    for (std::size_t i = 0; i < networks.size(); ++i) {
        fmt::print("| {} | {} | {:.1f} | {:.0f} | {:.2f} |\n",
                   networks[i].copies,
                   networks[i].arcs,
                   networks[i].build_s,
                   positions / took_s[i],
                   took_s[i] / took_s[0]);
    }
    fmt::print("\nPlain Newson-Krumm on one copy: {:.0f} positions/s. Peak memory of this program: "
               "{:.0f} MB.\n\n",
               positions / plain_s,
               peak_mb());
}

void print_lengths(const RoadNetwork& roads, const TripLog& hour) {
    struct Part {
        const char* what;
        TripLog trip;
    };
    const std::vector<Part> parts{{"7.5 minutes, 1 Hz", positions_of(hour, 10, 450)},
                                  {"15 minutes, 1 Hz", positions_of(hour, 10, 900)},
                                  {"30 minutes, 1 Hz", positions_of(hour, 10, 1800)},
                                  {"an hour, 1 Hz", positions_of(hour, 10, 3600)},
                                  {"an hour, 10 Hz", positions_of(hour, 1, 3600)},
                                  {"an hour, 10 Hz, with odometer, course and gyro", hour}};
    std::vector<std::function<void()>> works;
    works.reserve(parts.size());
    for (const auto& part : parts) {
        works.emplace_back([&] { matched(part.trip, roads); });
    }
    const auto took_s = medians_s(works);
    print_goal({"CPU ms for an hour at 10 Hz, positions",
                "< 100",
                fmt::format("{:.0f}", 1000 * took_s[4]),
                ""});
    print_goal({"CPU ms for an hour at 10 Hz, all sensors",
                "< 100",
                fmt::format("{:.0f}", 1000 * took_s[5]),
                ""});
    fmt::print("### Growth with the trip, on the largest network\n\n"
               "| trip | positions | CPU ms | positions/s |\n|---|---|---|---|\n");
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto count = parts[i].trip.fixes.size();
        fmt::print("| {} | {} | {:.1f} | {:.0f} |\n",
                   parts[i].what,
                   count,
                   1000 * took_s[i],
                   static_cast<double>(count) / took_s[i]);
    }
    fmt::print("\n");
}

void measure(const Options& options) {
    const auto ways = ways_of(options.files);
    const auto all = std::max(ten, (options.arcs + arcs_in(ways) - 1) / arcs_in(ways));
    std::vector<Sized> networks;
    for (const auto copies : {std::size_t{1}, ten, all}) {
        networks.push_back(sized(ways, copies));
    }
    print_growth(networks, trips_on(options.files));
    print_lengths(networks.back().roads, hour_long(options.files.front()));
}

} // namespace
} // namespace macadam::bench

int main(int count, char** words) {
    const std::vector<std::string> arguments(words + 1, words + count);
    if (arguments == std::vector<std::string>{"--help"}) {
        fmt::print("{}", macadam::bench::usage);
        return 0;
    }
    try {
        macadam::bench::measure(macadam::bench::parsed(arguments));
    } catch (const std::exception& error) {
        fmt::print(stderr, "large_network: {}\n", error.what());
        return 1;
    }
}
