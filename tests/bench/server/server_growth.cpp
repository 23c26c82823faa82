// What one PostgreSQL server costs as its database grows: trips stored by four writers until each
// segment has 20 passes, and, at each doubling, the bytes of a pass, fusion and reading. Prints a
// table.
//
//     server_growth postgresql://USER@/DATABASE?host=FOLDER [SIDE]
//
// The database is empty, with PostGIS. SIDE is that of the town, in crossings; 705 are ten million
// segments, for which the machine needs 60 GB of disk and an hour.

#include "app/progress/progress_display.hpp"
#include "estimator/common/error.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/reader/server_reader.hpp"

#include "bench/server/server_trips.hpp"
#include "support/roads/town.hpp"

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <random>
#include <stop_token>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <unistd.h>

namespace macadam::bench {
namespace {

constexpr int writers = 4;
constexpr std::size_t last_passes_a_segment = 20;
constexpr int doublings = 5;
constexpr std::size_t spread = 7'919; // a prime, so that trips lie everywhere
constexpr std::chrono::seconds fused_for{20};
constexpr int boxes = 30;
constexpr double box_deg = 0.009; // 1 km

/// Place in the middle of a town of so many crossings.
GeoPoint middle_of(int side) {
    constexpr double half_a_crossing_deg = 55 / 111'400.0;
    const auto& corner = testing::town_corner;
    return {corner.lat_deg + side * half_a_crossing_deg,
            corner.lon_deg + 2 * side * half_a_crossing_deg};
}

struct Stored {
    double trips_a_s = 0;
    double client_ms = 0; ///< CPU a trip
    double server_ms = 0; ///< CPU a trip
    double median_ms = 0; ///< until a trip is stored
};

struct Fused {
    double passes_a_s = 0;
    double passes_a_cpu_s = 0;
};

class Growth {
public:
    Growth(const std::string& address, int side)
        : address_{address}, monitor_{address}, middle_{middle_of(side)} {
        const ScratchFolder folder{"server_growth"};
        const auto roads = testing::made_up_town(side);
        RoadStore::create(folder / "roads.gpkg", roads, {});
        const double begin_s = wall_s();
        copy_to_server(folder / "roads.gpkg", address, {}, {});
        keys_ = keys_along_chunks(roads);
        fmt::print("{} segments copied to the server in {:.0f} s, {:.0f} bytes each.\n\n",
                   keys_.size(),
                   wall_s() - begin_s,
                   bytes_of("segment") / static_cast<double>(keys_.size()));
        for (int i = 0; i < writers; ++i) {
            open_.push_back(open_server_import(address));
        }
    }

    void run() {
        fmt::print(
            "| passes | trips/s | CPU a trip, client, ms | server, ms | a trip stored, median "
            "| bytes a pass | fused: passes/s | a CPU second | 1 km² read, median | its "
            "segments |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
        const std::size_t last = keys_.size() * last_passes_a_segment / passes_a_trip;
        const auto progress =
            progress_display("storing trips", {.name = "trip"}, isatty(STDERR_FILENO) != 0);
        const Progress shown{[&](std::size_t done, std::size_t) { progress(done, last); }, {}};
        for (int left = doublings; left >= 0; --left) {
            const auto stored = store_until(static_cast<int>(last >> left), shown);
            const double pass_bytes = bytes_of("drive") / passes();
            const auto fused = fuse();
            const auto read = read_boxes();
            fmt::print(
                "| {:.2f} M | {:.0f} | {:.2f} | {:.2f} | {:.1f} ms | {:.1f} | {:.0f} | {:.0f} "
                "| {:.1f} ms | {} |\n",
                passes() / 1e6,
                stored.trips_a_s,
                stored.client_ms,
                stored.server_ms,
                stored.median_ms,
                pass_bytes,
                fused.passes_a_s,
                fused.passes_a_cpu_s,
                read.median_ms,
                read.segments);
            std::fflush(stdout);
        }
    }

private:
    double passes() const { return static_cast<double>(trips_) * passes_a_trip; }

    /// With indexes, of all partitions.
    double bytes_of(const std::string& table) {
        return static_cast<double>(
            monitor_
                .numbers(fmt::format("SELECT sum(pg_total_relation_size(relid))::bigint FROM "
                                     "pg_partition_tree('macadam.{}')",
                                     table))
                .at(0));
    }

    Stored store_until(int trips, const Progress& progress) {
        const int first = trips_;
        std::atomic<int> next{first};
        std::vector<std::vector<double>> took_ms(writers);
        const auto cost = cost_of(monitor_, [&] {
            std::vector<std::jthread> threads;
            for (std::size_t writer = 0; writer < writers; ++writer) {
                threads.emplace_back([&, writer] {
                    for (int number = next++; number < trips; number = next++) {
                        const auto from = static_cast<std::size_t>(number) * spread *
                                          passes_a_trip % (keys_.size() - passes_a_trip);
                        const DrivenTrip trip{keys_, number, from};
                        const auto one = trip.as_new();
                        const double begin_s = wall_s();
                        open_[writer].trips->add_trips({&one, 1});
                        took_ms[writer].push_back(1e3 * (wall_s() - begin_s));
                        if (writer == 0) {
                            progress(static_cast<std::size_t>(number), 0);
                        }
                    }
                });
            }
        });
        trips_ = trips;
        std::vector<double> all_ms;
        for (const auto& own : took_ms) {
            all_ms.insert(all_ms.end(), own.begin(), own.end());
        }
        const double count = trips - first;
        return {count / cost.took_s,
                1e3 * cost.client_s / count,
                1e3 * cost.server_s / count,
                median(all_ms)};
    }

    /// Fuses what waits, for some seconds; the rest no longer waits.
    Fused fuse() {
        FusionRecord record;
        const auto cost = cost_of(monitor_, [&] {
            std::stop_source enough;
            const std::jthread timer{[&enough](const std::stop_token& fused_all) {
                std::mutex mutex;
                std::unique_lock lock{mutex};
                std::condition_variable_any time;
                time.wait_for(lock, fused_all, fused_for, [] { return false; });
                enough.request_stop();
            }};
            open_.front().trips->refresh(
                {.report = {}, .stop = enough.get_token()}, record, BusyChunks::await);
        });
        monitor_.run("TRUNCATE macadam.chunk_dirty");
        const double fused = passes() * static_cast<double>(record.segments.size()) /
                             static_cast<double>(keys_.size());
        return {fused / cost.took_s, fused / (cost.client_s + cost.server_s)};
    }

    struct Read {
        double median_ms;
        std::size_t segments; ///< of the last
    };

    /// Reads squares of 1 km in the middle of the town, as `query --bbox` does.
    Read read_boxes() const {
        std::mt19937 random{22};
        std::uniform_real_distribution<double> shift_deg{-3 * box_deg, 3 * box_deg};
        std::vector<double> took_ms;
        std::size_t segments = 0;
        for (int i = 0; i < boxes; ++i) {
            const double south_deg = middle_.lat_deg + shift_deg(random);
            const double west_deg = middle_.lon_deg + shift_deg(random);
            SegmentFilter filter;
            filter.with_state_only = false;
            filter.box = {west_deg, south_deg, west_deg + 2 * box_deg, south_deg + box_deg};
            const double begin_s = wall_s();
            const StoreReader reader{open_server_reader(
                address_, {.segments = filter, .content = {}}, Audience::operator_, {}, {})};
            segments = 0;
            reader.visit_summaries(filter, [&](const SegmentSummary&) { ++segments; });
            took_ms.push_back(1e3 * (wall_s() - begin_s));
        }
        return {median(took_ms), segments};
    }

    std::string address_;
    ServerConnection monitor_;
    std::vector<SegmentKey> keys_;
    std::vector<ServerImport> open_;
    GeoPoint middle_;
    int trips_ = 0;
};

int side_of(std::string_view word) {
    int side = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), side);
    if (error != std::errc{} || end != word.data() + word.size() || side < 30) {
        throw InputError{fmt::format("SIDE is '{}', expected crossings, 30 or more", word)};
    }
    return side;
}

} // namespace
} // namespace macadam::bench

int main(int count, char** words) {
    try {
        if (count != 2 && count != 3) {
            fmt::print(stderr,
                       "usage: server_growth postgresql://USER@/DATABASE?host=FOLDER [SIDE]\n");
            return 2;
        }
        const int side = count == 3 ? macadam::bench::side_of(words[2]) : 223;
        macadam::bench::Growth{words[1], side}.run();
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "server_growth: {}\n", error.what());
        return 1;
    }
}
