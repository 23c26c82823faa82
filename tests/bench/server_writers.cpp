// Rates at which workers write trips to one PostgreSQL server, and at which its passes are fused.
//
//     server_writers postgresql://USER@HOST/DATABASE      an empty database with PostGIS
//
// Each trip is a transaction, synced as the server is configured.

#include "mapping/passes/chunk_trace.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"

#include "bench/clock.hpp"
#include "bench/driven_town.hpp"
#include "support/roads/town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

namespace macadam::bench {
namespace {

constexpr int town_side = 40;
constexpr std::size_t passes_a_trip = 500;
constexpr int trips_of_each = 100;
constexpr double segment_length_m = 20;

/// Trip over 500 segments in a row, with a trace of each chunk.
struct DrivenTrip {
    DrivenTrip(std::span<const SegmentKey> keys, int number) : record{trip_number(number)} {
        const auto first = static_cast<std::size_t>(number) * 7'919 % (keys.size() - passes_a_trip);
        passes = passes_over(keys.subspan(first, passes_a_trip),
                             [&](std::int64_t i) { return 1500 + 37 * ((i * 7 + number) % 50); });
        for (auto& pass : passes) {
            pass.drive = 0;
            const auto chunk = chunk_of(pass.segment, segment_length_m);
            if (traces.empty() || !(traces.back().chunk == chunk)) {
                traces.push_back({.chunk = chunk,
                                  .drive = 0,
                                  .first_m = 0,
                                  .iri = std::vector<RoughnessCode>(130),
                                  .left = {},
                                  .place_sd_mm = 900});
                for (std::size_t i = 0; i < traces.back().iri.size(); ++i) {
                    traces.back().iri[i] = code_of(1 + 0.1 * double((i * 13 + i / 7) % 29));
                }
            }
        }
    }

    TripRecord record;
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
};

/// \returns trips per second.
double rate_of_writers(const std::string& address,
                       std::span<const SegmentKey> keys,
                       int writers,
                       int& next_trip) {
    std::vector<std::vector<DrivenTrip>> trips(static_cast<std::size_t>(writers));
    std::vector<ServerImport> open;
    for (auto& own : trips) {
        for (int i = 0; i < trips_of_each; ++i) {
            own.emplace_back(keys, next_trip++);
        }
        open.push_back(open_server_import(address));
    }
    const double begin_s = wall_s();
    {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < trips.size(); ++i) {
            threads.emplace_back([&, i] {
                for (const auto& trip : trips[i]) {
                    const NewTrip one{&trip.record, trip.passes, trip.traces};
                    open[i].trips->add_trips({&one, 1});
                }
            });
        }
    }
    return writers * trips_of_each / (wall_s() - begin_s);
}

void run(const std::string& address) {
    const ScratchFolder folder{"server_writers"};
    const auto roads = testing::made_up_town(town_side);
    RoadStore::create(folder / "roads.gpkg", roads, {});
    copy_to_server(folder / "roads.gpkg", address, {}, {});
    auto keys = keys_of(roads);
    std::ranges::sort(keys, {}, [](const SegmentKey& key) { // along whole chunks, 20 to 25 a trip
        return std::tuple{key.way_id, key.forward, key.index};
    });
    fmt::print("{} segments\n", keys.size());
    int next_trip = 0;
    const auto fuser = open_server_import(address);
    for (const int writers : {1, 2, 4}) {
        fmt::print("{} writers: {:.0f} trips/s of {} passes\n",
                   writers,
                   rate_of_writers(address, keys, writers, next_trip),
                   passes_a_trip);
    }
    FusionRecord record;
    const double begin_s = wall_s();
    const double cost = cost_s([&] { fuser.trips->refresh({}, record); });
    const double took_s = wall_s() - begin_s;
    const auto passes = static_cast<double>(next_trip) * passes_a_trip;
    fmt::print(
        "fused {} segments with {:.0f} passes: {:.0f} passes/s, {:.0f} a core of the client\n",
        record.segments.size(),
        passes,
        passes / took_s,
        passes / cost);
}

} // namespace
} // namespace macadam::bench

int main(int count, char** words) {
    try {
        if (count != 2) {
            fmt::print(stderr, "usage: server_writers postgresql://USER@HOST/DATABASE\n");
            return 2;
        }
        macadam::bench::run(words[1]);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "server_writers: {}\n", error.what());
        return 1;
    }
}
