// What the store costs: adding and fusing passes, and asking for about a thousand segments by place
// in stores of doubling size.

#include "storage/road_store.hpp"
#include "support/town.hpp"

#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>

#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Goes with the program.
struct ScratchFolder {
    fs::path path = fs::temp_directory_path() / ("macadam_bench_" + std::to_string(getpid()));
    ScratchFolder() { fs::create_directories(path); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

fs::path scratch(const std::string& name) {
    static const ScratchFolder folder;
    return folder.path / name;
}

std::vector<SegmentKey> keys_of(const RoadNetwork& roads) {
    std::vector<SegmentKey> keys;
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        for (const bool forward : {true, false}) {
            const auto edge = edge_of(LinkId{i}, forward);
            if (is_drivable(roads, edge)) {
                for (const auto& segment : segments_of(roads, edge)) {
                    keys.push_back(segment.key);
                }
            }
        }
    }
    return keys;
}

Pass pass_over(const SegmentKey& key, std::int64_t number) {
    const auto um = static_cast<IriUm>(1000 + (number * 7919) % 4000);
    return {.segment = key,
            .occurrence = 0,
            .iri_left_um = {},
            .iri_right_um = {},
            .iri_centre_um = um,
            .iri_um = um,
            .sd_um = um / 5,
            .centre_only = true,
            .validity = 0,
            .speed_mmps = 14000,
            .covered_mm = 20000,
            .confidence_ppm = 990000,
            .t_ms = number * 1400};
}

std::vector<Pass> passes_over(const std::vector<SegmentKey>& keys) {
    std::vector<Pass> passes;
    for (const auto& key : keys) {
        passes.push_back(pass_over(key, static_cast<std::int64_t>(passes.size())));
    }
    return passes;
}

TripRecord trip_number(int number) {
    TripRecord trip;
    trip.trip_id = "trip-" + std::to_string(number);
    trip.sha256 = std::string(56, '0') + std::to_string(10'000'000 + number);
    trip.vehicle_id = "car-" + std::to_string(number % 20);
    trip.t0_utc_ms = 1'767'225'600'000 + 3'600'000LL * number;
    return trip;
}

/// A town with one pass over each segment, fused.
const fs::path& driven_town(int side) {
    static std::map<int, fs::path> made;
    const auto known = made.find(side);
    if (known != made.end()) {
        return known->second;
    }
    const auto file = scratch("town-" + std::to_string(side) + ".gpkg");
    const auto roads = testing::made_up_town(side);
    auto store = RoadStore::create(file, roads, {});
    store.add_trip(trip_number(0), passes_over(keys_of(roads)));
    store.refresh({});
    return made.emplace(side, file).first->second;
}

/// About 1,000 segments in the middle of the town, whatever its size.
GeoBox middle_of(const RoadStore& store) {
    const auto box = store.info().box;
    const double lat = (box.south_deg + box.north_deg) / 2;
    const double lon = (box.west_deg + box.east_deg) / 2;
    constexpr double half_lat_deg = 0.0041;
    constexpr double half_lon_deg = 0.0080;
    return {.west_deg = lon - half_lon_deg,
            .south_deg = lat - half_lat_deg,
            .east_deg = lon + half_lon_deg,
            .north_deg = lat + half_lat_deg};
}

void ask_by_place(benchmark::State& state) {
    const auto store =
        RoadStore::open(driven_town(static_cast<int>(state.range(0))), RoadStore::Access::read);
    SegmentFilter filter;
    filter.box = middle_of(store);
    std::size_t seen = 0;
    for (auto _ : state) {
        seen = 0;
        store.visit(filter, [&](const SegmentRecord&) { ++seen; });
    }
    state.counters["found"] = static_cast<double>(seen);
    state.counters["segments"] = static_cast<double>(store.info().segments);
}

/// Trips of 500 passes into a town that already has one pass everywhere, fused after each trip.
void add_and_fuse_trips(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(0));
    const auto file = scratch("growing-" + std::to_string(side) + ".gpkg");
    fs::copy_file(driven_town(side), file, fs::copy_options::overwrite_existing);
    auto store = RoadStore::open(file, RoadStore::Access::write);
    const auto keys = keys_of(testing::made_up_town(side));
    constexpr std::size_t passes_a_trip = 500;
    static int number = 0;
    for (auto _ : state) {
        const auto first = static_cast<std::size_t>(number) * passes_a_trip;
        std::vector<SegmentKey> driven;
        for (std::size_t i = 0; i < passes_a_trip; ++i) {
            driven.push_back(keys[(first + i) % keys.size()]);
        }
        store.add_trip(trip_number(++number), passes_over(driven));
        store.refresh({});
    }
    state.counters["passes/s"] = benchmark::Counter(static_cast<double>(passes_a_trip) *
                                                        static_cast<double>(state.iterations()),
                                                    benchmark::Counter::kIsRate);
    state.counters["segments"] = static_cast<double>(keys.size());
}

BENCHMARK(ask_by_place)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(add_and_fuse_trips)->Arg(25)->Arg(50)->Arg(100)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace macadam
