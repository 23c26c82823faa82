// What map matching costs: the product beside the plain method of Newson and Krumm on the same
// trips, with trips and with networks of doubling size.

#include "bench/newson_krumm.hpp"
#include "mapping/map_match.hpp"
#include "support/town.hpp"

#include <benchmark/benchmark.h>

#include <map>

namespace macadam {
namespace {

using testing::Journey;

const RoadNetwork& town(int side) {
    static std::map<int, RoadNetwork> towns;
    const auto known = towns.find(side);
    return known != towns.end() ? known->second
                                : towns.emplace(side, testing::made_up_town(side)).first->second;
}

/// One fix a second, positions alone.
TripLog positions(const RoadNetwork& roads, std::size_t edges) {
    std::mt19937_64 random{7};
    const auto journey = testing::wander(roads, edges, random);
    return testing::recorded(roads, journey, {.sd_m = 5, .fix_step_s = 1, .speeds = false}, random);
}

void tell(benchmark::State& state, const TripLog& trip) {
    const auto done =
        static_cast<double>(trip.fixes.size()) * static_cast<double>(state.iterations());
    state.counters["fixes/s"] = benchmark::Counter(done, benchmark::Counter::kIsRate);
}

void match_in_macadam(benchmark::State& state, int side, std::size_t edges) {
    const auto& roads = town(side);
    const auto trip = positions(roads, edges);
    for (auto _ : state) {
        auto use = unused(trip);
        const auto odometer = make_odometer(trip, {}, use);
        benchmark::DoNotOptimize(map_match(trip, odometer, roads, {}, use));
    }
    tell(state, trip);
    state.SetComplexityN(static_cast<std::int64_t>(trip.fixes.size()));
}

void match_by_newson_krumm(benchmark::State& state) {
    const auto& roads = town(20);
    const auto trip = positions(roads, static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(bench::newson_krumm(trip, roads));
    }
    tell(state, trip);
}

void match_longer_trips(benchmark::State& state) {
    match_in_macadam(state, 20, static_cast<std::size_t>(state.range(0)));
}

void match_on_larger_networks(benchmark::State& state) {
    match_in_macadam(state, static_cast<int>(state.range(0)), 200);
    state.counters["edges"] =
        static_cast<double>(town(static_cast<int>(state.range(0))).out_edges.size());
}

BENCHMARK(match_by_newson_krumm)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(match_longer_trips)
    ->RangeMultiplier(2)
    ->Range(200, 1600)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMillisecond);
// Twice the side is four times the streets.
BENCHMARK(match_on_larger_networks)
    ->Arg(20)
    ->Arg(40)
    ->Arg(80)
    ->Arg(160)
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace macadam
