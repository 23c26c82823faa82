// Rates at which writers store trips on one PostgreSQL server, beside as many bare COPYs of the
// same bytes into a table without keys, and at which their passes are fused. Prints a table.
//
//     server_writers postgresql://USER@/DATABASE?host=FOLDER     an empty database with PostGIS
//
// Each trip is a transaction, synced as the server is configured. CPU is that of this process and
// of the server's, which run on this machine.

#include "mapping/passes/chunk_trace.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/drive_rows.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/server_tables.hpp"

#include "bench/server/server_trips.hpp"
#include "support/roads/town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace macadam::bench {
namespace {

constexpr int town_side = 40;
constexpr int trips_of_each = 100;
constexpr int rounds = 3;

using Trips = std::vector<std::vector<DrivenTrip>>; ///< of each writer

/// Each writer writes its trips one by one, beside the others.
template <typename Write>
void write_at_once(const Trips& trips, const Write& write) {
    std::vector<std::jthread> threads;
    for (std::size_t writer = 0; writer < trips.size(); ++writer) {
        threads.emplace_back([&, writer] {
            for (const auto& trip : trips[writer]) {
                write(writer, trip);
            }
        });
    }
}

Cost cost_of_trips(ServerConnection& monitor, std::span<ServerImport> open, const Trips& trips) {
    return cost_of(monitor, [&] {
        write_at_once(trips, [&](std::size_t writer, const DrivenTrip& trip) {
            const auto one = trip.as_new();
            open[writer].trips->add_trips({&one, 1});
        });
    });
}

/// The peer: the same drives, a COPY and a commit a trip.
Cost cost_of_copies(ServerConnection& monitor,
                    std::span<ServerConnection> bare,
                    const Trips& trips) {
    const auto& table = server_table("drive");
    return cost_of(monitor, [&] {
        write_at_once(trips, [&](std::size_t writer, const DrivenTrip& trip) {
            std::map<std::int64_t, ChunkDrive> drives;
            std::map<std::tuple<std::int64_t, bool, std::int64_t>, std::int64_t> chunks;
            for (const auto& trace : trip.traces) {
                const auto number = std::ssize(chunks);
                chunks[{trace.chunk.way_id, trace.chunk.forward, trace.chunk.number}] = number;
                drives[number].trace = drive_trace_of(trace);
            }
            for (const auto& pass : trip.passes) {
                const auto chunk = chunk_of(pass.segment, segment_length_m);
                drives[chunks.at({chunk.way_id, chunk.forward, chunk.number})].passes.push_back(
                    {pass.segment.index % 25, pass});
            }
            ServerTransaction all{bare[writer]};
            CopyWriter copy{bare[writer],
                            fmt::format("public.bare ({})", column_list(table)),
                            static_cast<int>(table.columns.size())};
            for (auto& [number, drive] : drives) {
                write_drive(copy, 1, {number, 1, 0}, std::move(drive));
            }
            copy.finish();
            all.commit();
        });
    });
}

std::string per_trip_ms(double total_s, std::size_t trips) {
    return fmt::format("{:.2f}", 1e3 * total_s / static_cast<double>(trips));
}

class Bench {
public:
    explicit Bench(const std::string& address) : address_{address}, monitor_{address} {
        const ScratchFolder folder{"server_writers"};
        const auto roads = testing::made_up_town(town_side);
        RoadStore::create(folder / "roads.gpkg", roads, {});
        copy_to_server(folder / "roads.gpkg", address, {}, {});
        keys_ = keys_along_chunks(roads);
        monitor_.run("CREATE TABLE public.bare (LIKE macadam.drive)");
        for (int i = 0; i < 4; ++i) {
            open_.push_back(open_server_import(address));
            bare_.emplace_back(address);
        }
    }

    void run() {
        fmt::print("| writers | trips/s | bare COPYs/s | times theirs | CPU a trip, client, ms | "
                   "server, ms | bare COPY, server, ms |\n|---|---|---|---|---|---|---|\n");
        for (const std::size_t writers : {1, 2, 4}) {
            measure(fmt::format("{}", writers), writers, false);
        }
        measure("4, all over the same roads", 4, true);
        fuse();
    }

private:
    Trips new_trips(std::size_t writers, bool same_roads) {
        Trips trips(writers);
        for (auto& own : trips) {
            for (int i = 0; i < trips_of_each; ++i, ++next_trip_) {
                const auto first = static_cast<std::size_t>(next_trip_) * 7'919;
                own.emplace_back(
                    keys_, next_trip_, same_roads ? 0 : first % (keys_.size() - passes_a_trip));
            }
        }
        return trips;
    }

    void measure(const std::string& name, std::size_t writers, bool same_roads) {
        std::vector<double> rates, bare_rates, ratios;
        Cost sum, bare_sum;
        for (int round = 0; round < rounds; ++round) {
            const auto trips = new_trips(writers, same_roads);
            const auto count = static_cast<double>(writers * trips_of_each);
            const auto bare = cost_of_copies(monitor_, bare_, trips);
            const auto ours = cost_of_trips(monitor_, open_, trips);
            rates.push_back(count / ours.took_s);
            bare_rates.push_back(count / bare.took_s);
            ratios.push_back(bare.took_s / ours.took_s);
            sum.client_s += ours.client_s;
            sum.server_s += ours.server_s;
            bare_sum.server_s += bare.server_s;
        }
        const auto all = writers * trips_of_each * rounds;
        fmt::print("| {} | {:.0f} | {:.0f} | {:.2f} | {} | {} | {} |\n",
                   name,
                   median(rates),
                   median(bare_rates),
                   median(ratios),
                   per_trip_ms(sum.client_s, all),
                   per_trip_ms(sum.server_s, all),
                   per_trip_ms(bare_sum.server_s, all));
        std::fflush(stdout);
    }

    void fuse() {
        FusionRecord record;
        const auto cost =
            cost_of(monitor_, [&] { open_.front().trips->refresh({}, record, BusyChunks::await); });
        const auto passes = static_cast<double>(next_trip_) * passes_a_trip;
        fmt::print("\n{} segments with {:.0f} passes fused: {:.0f} passes/s, {:.0f} a CPU second "
                   "of client and server, {:.0f} of the client\n",
                   record.segments.size(),
                   passes,
                   passes / cost.took_s,
                   passes / (cost.client_s + cost.server_s),
                   passes / cost.client_s);
    }

    std::string address_;
    ServerConnection monitor_;
    std::vector<SegmentKey> keys_;
    std::vector<ServerImport> open_;
    std::vector<ServerConnection> bare_;
    int next_trip_ = 0;
};

} // namespace
} // namespace macadam::bench

int main(int count, char** words) {
    try {
        if (count != 2) {
            fmt::print(stderr, "usage: server_writers postgresql://USER@/DATABASE?host=FOLDER\n");
            return 2;
        }
        macadam::bench::Bench{words[1]}.run();
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "server_writers: {}\n", error.what());
        return 1;
    }
}
