// What a road network costs: reading its map, building it, its file, and opening that.

#include "mapping/matching/arcs.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/networks/network_reader.hpp"

#include <fmt/format.h>

#include <sys/resource.h>

#include <chrono>
#include <exception>
#include <filesystem>
#include <iostream>
#include <random>
#include <string>
#include <utility>

namespace {

using namespace macadam;

constexpr const char* usage =
    "usage: network_bench MAP NETWORK\n\n"
    "Reads a map, builds its network, writes that to the file NETWORK and "
    "opens it; prints what each took.\n";

class Clock {
public:
    double lap_s() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> lap = now - std::exchange(start_, now);
        return lap.count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double max_memory_gb() {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    constexpr double gb_per_kib = 1024 / 1e9;
    return static_cast<double>(use.ru_maxrss) * gb_per_kib;
}

/// Consecutive points of ways, once for each direction that may be driven.
std::size_t arcs_of(const RoadNetwork& roads) {
    std::size_t arcs = 0;
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        const auto way = way_at(roads, i);
        arcs += (way.line.size() - 1) * (way.oneway == Oneway::no ? 2 : 1);
    }
    return arcs;
}

void print_size(const RoadNetwork& roads, std::uintmax_t bytes) {
    const auto edges = drivable_edges(roads).size();
    const auto arcs = arcs_of(roads);
    const auto per = [&](std::size_t count) {
        return static_cast<double>(bytes) / static_cast<double>(count);
    };
    std::cout << fmt::format("{} ways, {} points, {} links, {} nodes\n",
                             way_count(roads),
                             roads.points.size(),
                             link_count(roads),
                             node_count(roads));
    std::cout << fmt::format(
        "{} directed edges from junction to junction: {:.1f} B each\n", edges, per(edges));
    std::cout << fmt::format(
        "{} directed arcs from point to point: {:.1f} B each\n", arcs, per(arcs));
    std::cout << fmt::format("{} forbidden turns\n", roads.turn_restrictions.size());
}

/// Microseconds of looking for roads within 50 m of a place on a road.
double look_up_us(const RoadNetwork& roads) {
    constexpr int look_ups = 100'000;
    std::mt19937_64 random{1};
    std::size_t found = 0;
    Clock clock;
    for (int i = 0; i < look_ups; ++i) {
        const NodeId node{static_cast<std::uint32_t>(random() % node_count(roads))};
        found += links_near(roads, grown(including({}, place_of(roads, node)), 50)).size();
    }
    std::cout << fmt::format("{:.1f} links within 50 m of a node, ",
                             static_cast<double>(found) / look_ups);
    return clock.lap_s() * 1e6 / look_ups;
}

void measure(const std::filesystem::path& map, const std::filesystem::path& file) {
    Clock clock;
    {
        auto ways = read_network(map);
        std::cout << fmt::format("read in {:.1f} s\n", clock.lap_s());
        const auto roads = build_network(std::move(ways));
        std::cout << fmt::format("built in {:.1f} s\n", clock.lap_s());
        write_network_file(roads, std::string(64, '0'), file);
        std::cout << fmt::format("written in {:.1f} s\n", clock.lap_s());
        std::cout << fmt::format("at most {:.2f} GB of memory\n", max_memory_gb());
    }
    clock.lap_s();
    const auto opened = open_network_file(file);
    std::cout << fmt::format("opened in {:.3f} s\n", clock.lap_s());
    print_size(opened.roads, std::filesystem::file_size(file));
    std::cout << fmt::format("found in {:.2f} us\n", look_up_us(opened.roads));
}

} // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        std::cerr << usage;
        return 2;
    }
    try {
        measure(arguments[1], arguments[2]);
    } catch (const std::exception& error) {
        std::cerr << "network_bench: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
