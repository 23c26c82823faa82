// What the store costs: adding and fusing passes with and without their traces, one trip at a time
// and many at once, laying ever more traces of a chunk on each other, and asking for about a
// thousand segments by place in stores of doubling size; and how long readers take beside a writer.

#include "clock.hpp"
#include "driven_town.hpp"
#include "mapping/alignment/alignment.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/store/road_store.hpp"
#include "support/roads/roughness_pattern.hpp"
#include "support/roads/town.hpp"

#include <benchmark/benchmark.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

namespace macadam {
namespace {

namespace fs = std::filesystem;

using bench::keys_of;
using bench::trip_number;

fs::path scratch(const std::string& name) {
    static const bench::ScratchFolder folder{"macadam_bench"};
    return folder / name;
}

std::vector<Pass> passes_over(const std::vector<SegmentKey>& keys) {
    return bench::passes_over(keys,
                              [](std::int64_t number) { return 1000 + (number * 7919) % 4000; });
}

/// What trip `number` reads of a road of that length, some metres off its place.
RoughnessTrace trace_of_trip(int number, double length_m) {
    static const auto pattern = testing::roughness_pattern(1000, 1);
    const double lag_m = (number * 37) % 60 / 10.0 - 3;
    return testing::read_pattern(pattern,
                                 {.from_m = -10,
                                  .to_m = std::ceil(length_m) + 10,
                                  .lag_m = [=](double) { return lag_m - 20; },
                                  .seed = static_cast<std::uint64_t>(number)});
}

/// The traces of all chunks of those segments; passes of about 20 m.
std::vector<RoughnessTrace> traces_over(const std::vector<SegmentKey>& keys, int number) {
    std::vector<RoughnessTrace> traces;
    for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
        const auto chunk = chunk_of(keys[first], 20);
        while (last < keys.size() && chunk_of(keys[last], 20) == chunk) {
            ++last;
        }
        auto trace = trace_of_trip(number, 20.0 * static_cast<double>(last - first));
        trace.chunk = chunk;
        // Two trips' worth of one chunk in one trip are two drives.
        trace.drive = static_cast<std::uint32_t>(traces.size());
        traces.push_back(std::move(trace));
    }
    return traces;
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
    store.refresh();
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

constexpr std::size_t passes_a_trip = 500;

/// What trip `number` gives, where trips go on from each other through the town.
struct TownDrive {
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
};

TownDrive town_drive(const std::vector<SegmentKey>& keys, int number, bool with_traces) {
    const auto first = static_cast<std::size_t>(number) * passes_a_trip;
    std::vector<SegmentKey> driven;
    for (std::size_t i = 0; i < passes_a_trip; ++i) {
        driven.push_back(keys[(first + i) % keys.size()]);
    }
    TownDrive drive{passes_over(driven), {}};
    if (with_traces) {
        drive.traces = traces_over(driven, number);
        for (std::size_t i = 0, trace = 0; i < drive.passes.size(); ++i) {
            auto& pass = drive.passes[i];
            trace += chunk_of(pass.segment, 20) != drive.traces[trace].chunk ? 1U : 0U;
            pass.drive = drive.traces[trace].drive;
        }
    }
    return drive;
}

/// Trips of 500 passes into a town that already has one pass everywhere, fused after each trip;
/// with_traces: each pass laid on the others.
template <bool with_traces>
void add_and_fuse_trips(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(0));
    const auto file = scratch("growing-" + std::to_string(side) + ".gpkg");
    fs::copy_file(driven_town(side), file, fs::copy_options::overwrite_existing);
    auto store = RoadStore::open(file, RoadStore::Access::write);
    const auto keys = keys_of(testing::made_up_town(side));
    static int number = 0;
    for (auto _ : state) {
        state.PauseTiming();
        const auto drive = town_drive(keys, number, with_traces);
        state.ResumeTiming();
        store.add_trip(trip_number(++number), drive.passes, drive.traces);
        store.refresh();
    }
    state.counters["passes/s"] = benchmark::Counter(static_cast<double>(passes_a_trip) *
                                                        static_cast<double>(state.iterations()),
                                                    benchmark::Counter::kIsRate);
    state.counters["segments"] = static_cast<double>(keys.size());
}

/// A store of a small town with so many trips that nobody fused yet.
template <bool with_traces>
const fs::path& waiting_town(int trips) {
    static std::map<int, fs::path> made;
    const auto known = made.find(trips);
    if (known != made.end()) {
        return known->second;
    }
    const auto file =
        scratch("waiting-" + std::to_string(trips) + (with_traces ? "-traces" : "") + ".gpkg");
    const auto roads = testing::made_up_town(25);
    const auto keys = keys_of(roads);
    auto store = RoadStore::create(file, roads, {});
    for (int number = 0; number < trips; ++number) {
        const auto drive = town_drive(keys, number, with_traces);
        store.add_trip(trip_number(number), drive.passes, drive.traces);
    }
    return made.emplace(trips, file).first->second;
}

/// The fusion of many trips at once; with_traces: each pass laid on the others.
template <bool with_traces>
void fuse_trips(benchmark::State& state) {
    const auto trips = static_cast<int>(state.range(0));
    const auto file = scratch("fused.gpkg");
    for (auto _ : state) {
        state.PauseTiming();
        fs::copy_file(waiting_town<with_traces>(trips), file, fs::copy_options::overwrite_existing);
        auto store = RoadStore::open(file, RoadStore::Access::write);
        state.ResumeTiming();
        store.refresh();
    }
    state.counters["passes/s"] =
        benchmark::Counter(static_cast<double>(passes_a_trip) * static_cast<double>(trips) *
                               static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate);
}

constexpr int trips_in_batch = 1000;

/// A batch of trips that nobody added yet.
struct Batch {
    std::vector<TripRecord> records;
    std::vector<TownDrive> drives;
    std::vector<NewTrip> trips; ///< of these
};

const Batch& batch_over(const std::vector<SegmentKey>& keys, bool with_traces) {
    static std::map<std::pair<std::size_t, bool>, Batch> made;
    auto& batch = made[{keys.size(), with_traces}];
    if (batch.trips.empty()) {
        for (int number = 0; number < trips_in_batch; ++number) {
            batch.records.push_back(trip_number(50'000 + number));
            batch.drives.push_back(town_drive(keys, number, with_traces));
        }
        for (std::size_t i = 0; i < batch.records.size(); ++i) {
            const auto& drive = batch.drives[i];
            batch.trips.push_back({&batch.records[i], drive.passes, drive.traces});
        }
    }
    return batch;
}

void count_passes(benchmark::State& state, double passes) {
    state.counters["passes/s"] = benchmark::Counter(
        passes * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

/// 1,000 trips of 500 passes at once into a town that has one pass everywhere. with_state: with
/// their traces, and fused; else the rows of passes alone.
template <bool with_state>
void add_batch(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(0));
    const auto file = scratch("batch-" + std::to_string(side) + ".gpkg");
    const auto& batch = batch_over(keys_of(testing::made_up_town(side)), with_state);
    for (auto _ : state) {
        state.PauseTiming();
        fs::copy_file(driven_town(side), file, fs::copy_options::overwrite_existing);
        auto store = RoadStore::open(file, RoadStore::Access::write);
        state.ResumeTiming();
        store.add_trips(batch.trips);
        if (with_state) {
            store.refresh();
        }
    }
    count_passes(state, static_cast<double>(passes_a_trip) * trips_in_batch);
}

/// The peer of a batch's rows: SQLite inserts as many into a table of that kind and nothing else.
void insert_bare_rows(benchmark::State& state) {
    const auto& batch =
        batch_over(keys_of(testing::made_up_town(static_cast<int>(state.range(0)))), false);
    for (auto _ : state) {
        const auto file = scratch("bare.db");
        fs::remove(file);
        Database database{file, Database::Access::create};
        database.run(
            "CREATE TABLE pass (segment INTEGER, trip INTEGER, occurrence INTEGER, a, b, c,"
            " d, e, f, g, h, i, j, k, l, PRIMARY KEY (segment, trip, occurrence))"
            " WITHOUT ROWID");
        Transaction all{database, Transaction::Kind::write};
        auto insert = database.prepare(
            "INSERT INTO pass VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
        std::int64_t trip = 0;
        for (const auto& new_trip : batch.trips) {
            ++trip;
            for (const auto& pass : new_trip.passes) {
                insert.run(40 * pass.segment.way_id + pass.segment.index,
                           trip,
                           pass.segment.forward,
                           std::nullopt,
                           std::nullopt,
                           std::int64_t{pass.iri_um},
                           std::int64_t{pass.iri_um},
                           std::int64_t{pass.sd_um},
                           pass.centre_only,
                           std::int64_t{pass.validity},
                           std::int64_t{pass.speed_mmps},
                           std::int64_t{pass.covered_mm},
                           std::int64_t{pass.confidence_ppm},
                           pass.t_ms,
                           std::nullopt);
            }
        }
        all.commit();
    }
    count_passes(state, static_cast<double>(passes_a_trip) * trips_in_batch);
}

/// A store for a town's network; the peer is the insertion of the same rows under the triggers that
/// keep a GeoPackage's R-tree.
void make_store(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(0));
    const auto roads = testing::made_up_town(side);
    const auto file = scratch("made.gpkg");
    std::size_t segments = 0;
    for (auto _ : state) {
        fs::remove(file);
        segments = RoadStore::create(file, roads, {}).info().segments;
    }
    state.counters["segments/s"] =
        benchmark::Counter(static_cast<double>(segments) * static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate);
    state.counters["bytes/segment"] =
        static_cast<double>(fs::file_size(file)) / static_cast<double>(segments);
}

void insert_under_triggers(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(0));
    const auto from = scratch("made.gpkg");
    if (!fs::exists(from)) {
        RoadStore::create(from, testing::made_up_town(side), {});
    }
    std::int64_t segments = 0;
    for (auto _ : state) {
        const auto file = scratch("triggered.gpkg");
        fs::remove(file);
        Database database{file, Database::Access::create};
        add_geometry_functions(database);
        database.run("PRAGMA trusted_schema = ON"); // or triggers cannot write an R-tree
        database.prepare("ATTACH ? AS made").run(from.string());
        Transaction all{database, Transaction::Kind::write};
        make_geopackage(database);
        database.run("CREATE TABLE segment (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,"
                     " geom LINESTRING, segment TEXT NOT NULL, way_id INTEGER NOT NULL,"
                     " direction TEXT NOT NULL, seq INTEGER NOT NULL, from_m DOUBLE NOT NULL,"
                     " to_m DOUBLE NOT NULL, strip INTEGER NOT NULL)");
        index_features(database, "segment");
        database.run("INSERT INTO segment SELECT * FROM made.segment");
        all.commit();
        segments = database.number("SELECT count(*) FROM segment");
    }
    state.counters["segments/s"] =
        benchmark::Counter(static_cast<double>(segments) * static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate);
}

/// How long a reader takes to open a store and ask for about 1,000 segments by place, alone (0) or
/// while another thread imports trips of 500 passes without a pause (1).
void read_beside_a_writer(benchmark::State& state) {
    const auto file = scratch("written.gpkg");
    const auto& town = driven_town(50);
    fs::copy_file(town, file, fs::copy_options::overwrite_existing);
    const auto keys = keys_of(testing::made_up_town(50));
    SegmentFilter filter;
    filter.box = middle_of(RoadStore::open(file, RoadStore::Access::read));
    std::atomic<int> trips = 0;
    std::jthread writer;
    if (state.range(0) == 1) {
        writer = std::jthread{[&](const std::stop_token& stop) {
            auto store = RoadStore::open(file, RoadStore::Access::write);
            while (!stop.stop_requested()) {
                const auto first = static_cast<std::size_t>(trips) * 500 % (keys.size() - 500);
                const std::vector<SegmentKey> driven{keys.begin() + static_cast<long>(first),
                                                     keys.begin() + static_cast<long>(first + 500)};
                store.add_trip(trip_number(20'000 + ++trips), passes_over(driven));
                store.refresh();
            }
        }};
    }
    std::vector<double> times_ms;
    for (auto _ : state) {
        const double begin_s = bench::wall_s();
        const auto store = RoadStore::open(file, RoadStore::Access::read);
        store.visit(filter, [](const SegmentRecord&) {});
        times_ms.push_back(1e3 * (bench::wall_s() - begin_s));
    }
    state.counters["p50_ms"] = bench::median(times_ms);
    state.counters["p99_ms"] = bench::percentile(times_ms, 99);
    state.counters["worst_ms"] = bench::percentile(times_ms, 100);
    state.counters["trips"] = trips.load();
}

/// Twice as many traces of 500 m should cost twice as much.
void align_traces(benchmark::State& state) {
    std::vector<RoughnessTrace> traces;
    for (int number = 0; number < state.range(0); ++number) {
        traces.push_back(trace_of_trip(number, 500));
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(lags_of(traces, {}));
    }
    state.counters["passes/s"] = benchmark::Counter(25.0 * static_cast<double>(state.range(0)) *
                                                        static_cast<double>(state.iterations()),
                                                    benchmark::Counter::kIsRate);
}

BENCHMARK(align_traces)->RangeMultiplier(4)->Range(2, 512)->Unit(benchmark::kMillisecond);
BENCHMARK(make_store)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(insert_under_triggers)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(ask_by_place)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(read_beside_a_writer)->Arg(0)->Arg(1)->Iterations(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(add_and_fuse_trips<false>)->Arg(25)->Arg(50)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(add_and_fuse_trips<true>)->Arg(25)->Arg(50)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(add_batch<false>)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(insert_bare_rows)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(add_batch<true>)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(fuse_trips<false>)->Arg(50)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(fuse_trips<true>)->Arg(50)->Arg(200)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace macadam
