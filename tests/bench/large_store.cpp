// What a store costs at ten million segments: making it, also beside the same rows inserted under
// the triggers that keep a GeoPackage's R-tree, a pass everywhere, a batch of 1,000 trips more,
// questions, and readers beside a writer. Prints a table; the stores go away with the program.
//
//     large_store [SIDE [ROWS]]    crossings along a side of the town; 705 are ten million
//     segments.
//                                  ROWS of them go in under the triggers as well, usually all: they
//                                  take their time

#include "clock.hpp"
#include "driven_town.hpp"
#include "estimator/common/error.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/road_store.hpp"
#include "support/roads/town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace bench;

constexpr int questions = 2000;
constexpr std::size_t passes_a_trip = 500;
constexpr int trips_in_batch = 1000;

void row(std::string_view what, const std::string& figures) {
    fmt::print("| {} | {} |\n", what, figures);
    std::fflush(stdout);
}

std::string spread(const std::vector<double>& ms) {
    return fmt::format("p50 {:.3f}, p95 {:.3f}, p99 {:.3f}, worst {:.1f} ms",
                       percentile(ms, 50),
                       percentile(ms, 95),
                       percentile(ms, 99),
                       percentile(ms, 100));
}

std::vector<Pass> passes_of_trip(std::span<const SegmentKey> keys, int trip) {
    return passes_over(
        keys, [trip](std::int64_t number) { return 1000 + (number * 7919 + 31 * trip) % 1000; });
}

/// Trips that go on from each other.
struct Batch {
    std::vector<TripRecord> records;
    std::vector<std::vector<Pass>> passes;
    std::vector<NewTrip> trips; ///< of these
};

Batch batch_of(std::span<const SegmentKey> keys, int first_trip, int count) {
    Batch batch;
    for (int i = 0; i < count; ++i) {
        const auto first =
            static_cast<std::size_t>(i) * passes_a_trip % (keys.size() - passes_a_trip);
        batch.records.push_back(trip_number(first_trip + i));
        batch.passes.push_back(passes_of_trip(keys.subspan(first, passes_a_trip), first_trip + i));
    }
    for (std::size_t i = 0; i < batch.records.size(); ++i) {
        batch.trips.push_back({&batch.records[i], batch.passes[i], {}});
    }
    return batch;
}

void drive_everywhere(RoadStore& store, std::span<const SegmentKey> keys) {
    constexpr std::size_t keys_at_once = 500'000;
    for (std::size_t first = 0, trip = 0; first < keys.size(); first += keys_at_once, ++trip) {
        const auto some = keys.subspan(first, std::min(keys_at_once, keys.size() - first));
        const auto number = static_cast<int>(trip);
        add_trip(store, trip_number(number), passes_of_trip(some, number));
    }
    store.importer.refresh();
}

/// Places all over the town.
Segment place(const RoadNetwork& roads, int number) {
    const auto link = static_cast<std::uint64_t>(number) * 7'919'003 % link_count(roads);
    return segments_of(roads, edge_of(LinkId{static_cast<std::uint32_t>(link)}, true)).front();
}

SegmentFilter around(const Segment& segment, double lat_deg, double lon_deg) {
    const auto at = segment.line.front();
    SegmentFilter filter;
    filter.box = GeoBox{.west_deg = at.lon_deg - lon_deg,
                        .south_deg = at.lat_deg - lat_deg,
                        .east_deg = at.lon_deg + lon_deg,
                        .north_deg = at.lat_deg + lat_deg};
    return filter;
}

/// \param answer  asks the store by a filter; returns how many segments it got.
template <typename Question, typename Answer>
void ask(std::string_view what, const RoadNetwork& roads, Question question, Answer answer) {
    std::vector<double> ms;
    std::size_t found = 0;
    for (int i = 0; i < questions; ++i) {
        const auto filter = question(place(roads, i));
        const double begin_s = cpu_s(CLOCK_THREAD_CPUTIME_ID);
        found += answer(filter);
        ms.push_back(1e3 * (cpu_s(CLOCK_THREAD_CPUTIME_ID) - begin_s));
    }
    row(fmt::format("{} ({} segments), CPU", what, found / questions), spread(ms));
}

void ask_all(const fs::path& file, const RoadNetwork& roads) {
    const auto store = StoreReader::open(file);
    const auto all_of = [&](const SegmentFilter& filter) {
        std::size_t count = 0;
        store.visit(filter, [&](const SegmentRecord&) { ++count; });
        return count;
    };
    const auto glance_at = [&](const SegmentFilter& filter) {
        std::size_t count = 0;
        store.visit_summaries(filter, [&](const SegmentSummary&) { ++count; });
        return count;
    };
    const auto box = [](const Segment& at) { return around(at, 0.0034, 0.0068); };
    ask("box", roads, box, all_of);
    ask("box, at a glance", roads, box, glance_at);
    ask(
        "near", roads, [](const Segment& at) { return around(at, 0.0002, 0.0003); }, all_of);
    const auto way = [](const Segment& at) {
        SegmentFilter filter;
        filter.way_id = at.key.way_id;
        return filter;
    };
    ask("way", roads, way, all_of);
    const auto segment = [](const Segment& at) {
        SegmentFilter filter;
        filter.key = at.key;
        return filter;
    };
    ask("segment", roads, segment, all_of);
}

/// A reader opens the store and asks by box, again and again, while a writer adds trips and fuses.
void read_beside_a_writer(const fs::path& file,
                          const RoadNetwork& roads,
                          std::span<const SegmentKey> keys) {
    std::atomic<int> trips = 0;
    std::jthread writer{[&](const std::stop_token& stop) {
        auto store = RoadStore::open(file);
        for (int number = 100'000; !stop.stop_requested(); ++number, ++trips) {
            const auto first = static_cast<std::size_t>(number) * 7919 * passes_a_trip %
                               (keys.size() - passes_a_trip);
            const auto driven = keys.subspan(first, passes_a_trip);
            add_trip(store, trip_number(number), passes_of_trip(driven, number));
            store.importer.refresh();
        }
    }};
    std::vector<double> ms;
    for (int i = 0; i < questions; ++i) {
        const auto filter = around(place(roads, i), 0.0034, 0.0068);
        const double begin_s = wall_s();
        StoreReader::open(file).visit(filter, [](const SegmentRecord&) {});
        ms.push_back(1e3 * (wall_s() - begin_s));
    }
    writer.request_stop();
    writer.join();
    row(fmt::format("open and box, beside a writer ({} trips meanwhile), wall", trips.load()),
        spread(ms));
}

/// What SQLite itself finds wrong with the R-tree.
std::string found_in_rtree(const fs::path& file) {
    Database database{file, Database::Access::read};
    auto check = database.prepare("SELECT rtreecheck('rtree_segment_geom')");
    check.step();
    return check.text(0);
}

/// The peer of init: as many of the same rows inserted under the triggers of the standard. Rows a
/// CPU second.
double triggered_rate(const fs::path& made, std::int64_t rows, const fs::path& file) {
    Database database{file, Database::Access::create};
    add_geometry_functions(database);
    database.run("PRAGMA trusted_schema = ON"); // or triggers cannot write an R-tree
    database.prepare("ATTACH ? AS made").run(made.string());
    const double cost = cost_s([&] {
        Transaction all{database, Transaction::Kind::write};
        make_geopackage(database);
        database.run("CREATE TABLE segment (fid INTEGER PRIMARY KEY NOT NULL,"
                     " geom LINESTRING, segment TEXT NOT NULL, way_id INTEGER NOT NULL,"
                     " direction TEXT NOT NULL, seq INTEGER NOT NULL, from_m DOUBLE NOT NULL,"
                     " to_m DOUBLE NOT NULL, strip INTEGER NOT NULL)");
        index_features(database, "segment");
        database.prepare("INSERT INTO segment SELECT * FROM made.segment ORDER BY fid LIMIT ?")
            .run(rows);
        all.commit();
    });
    return static_cast<double>(rows) / cost;
}

void measure_init(const fs::path& file, const RoadNetwork& roads, std::int64_t triggered_rows) {
    const double made_s = cost_s([&] { RoadStore::create(file, roads, {}); });
    const auto bytes = static_cast<double>(fs::file_size(file));
    const auto count = std::ssize(keys_of(roads));
    const double rate = static_cast<double>(count) / made_s;
    row("init",
        fmt::format("{:.0f} segments/s, {:.0f} bytes a segment, rtreecheck: {}",
                    rate,
                    bytes / static_cast<double>(count),
                    found_in_rtree(file)));
    if (const auto rows = std::min<std::int64_t>(count, triggered_rows); rows > 0) {
        const auto peer = file.string() + ".triggered";
        const double peer_rate = triggered_rate(file, rows, peer);
        fs::remove(peer);
        row(fmt::format("{} of their rows under SQLite's triggers", rows),
            fmt::format(
                "{:.0f} segments/s; init is {:.1f} times as fast", peer_rate, rate / peer_rate));
    }
}

void measure(int side, std::int64_t triggered_rows, const fs::path& file) {
    const auto roads = testing::made_up_town(side);
    const auto keys = keys_of(roads);
    const auto count = static_cast<double>(keys.size());
    fmt::print("{} segments, {} questions each.\n\n| what | figures |\n|---|---|\n",
               keys.size(),
               questions);
    measure_init(file, roads, triggered_rows);
    const auto bare_bytes = static_cast<double>(fs::file_size(file));

    const double driven_s = cost_s([&] {
        auto store = RoadStore::open(file);
        drive_everywhere(store, keys);
    });
    row("a pass over each, with state",
        fmt::format("{:.0f} passes/s, {:.0f} bytes a pass",
                    count / driven_s,
                    (static_cast<double>(fs::file_size(file)) - bare_bytes) / count));
    ask_all(file, roads);

    const auto batch = batch_of(keys, 50'000, trips_in_batch);
    auto store = RoadStore::open(file);
    constexpr double passes = static_cast<double>(passes_a_trip) * trips_in_batch;
    const double added_s = cost_s([&] { store.importer.add_trips(batch.trips); });
    const double fused_s = cost_s([&] { store.importer.refresh(); });
    row("1,000 trips of 500 passes: their rows", fmt::format("{:.0f} passes/s", passes / added_s));
    row("1,000 trips of 500 passes: with state",
        fmt::format("{:.0f} passes/s", passes / (added_s + fused_s)));
    read_beside_a_writer(file, roads, keys);
}

} // namespace
} // namespace macadam

int main(int argc, char** argv) {
    namespace fs = std::filesystem;
    const auto file =
        fs::temp_directory_path() / fmt::format("macadam_large_store_{}.gpkg", getpid());
    int status = 0;
    try {
        const int side = argc > 1 ? std::atoi(argv[1]) : 705;
        constexpr std::int64_t all = 1'000'000'000;
        macadam::measure(side, argc > 2 ? std::atoll(argv[2]) : all, file);
    } catch (const macadam::InputError& error) {
        fmt::print(stderr, "large_store: {}\n", error.what());
        status = 1;
    }
    std::error_code ignored;
    fs::remove(file, ignored);
    return status;
}
