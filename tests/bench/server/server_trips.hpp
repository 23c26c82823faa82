#pragma once

#include "mapping/alignment/alignment.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/postgres/server_connection.hpp"

#include "bench/clock.hpp"
#include "bench/driven_town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <span>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <unistd.h>

namespace macadam::bench {

inline constexpr std::size_t passes_a_trip = 500;
inline constexpr double segment_length_m = 20;

/// Keys of all segments, along whole chunks.
inline std::vector<SegmentKey> keys_along_chunks(const RoadNetwork& roads) {
    auto keys = keys_of(roads);
    std::ranges::sort(keys, {}, [](const SegmentKey& key) {
        return std::tuple{key.way_id, key.forward, key.index};
    });
    return keys;
}

/// Trip over 500 segments in a row, with a trace of each chunk.
struct DrivenTrip {
    DrivenTrip(std::span<const SegmentKey> keys, int number, std::size_t first)
        : record{trip_number(number)} {
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

    NewTrip as_new() const { return {&record, passes, traces}; }

    TripRecord record;
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
};

/// CPU that processes of the server took so far, if they run here; those of connections that ended
/// do not count.
inline double server_cpu_s(ServerConnection& server) {
    double ticks = 0;
    for (const auto pid : server.numbers("SELECT pid FROM pg_stat_activity"
                                         " WHERE pid <> pg_backend_pid()")) {
        std::ifstream file{fmt::format("/proc/{}/stat", pid)};
        std::string stat{std::istreambuf_iterator<char>{file}, {}};
        std::istringstream fields{stat.substr(std::min(stat.rfind(')'), stat.size() - 1) + 1)};
        std::string field;
        for (int number = 3; number <= 15 && fields >> field; ++number) {
            ticks += number >= 14 ? std::stod(field) : 0; // user, system: proc(5)
        }
    }
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

struct Cost {
    double took_s = 0;
    double client_s = 0; ///< CPU
    double server_s = 0; ///< CPU
};

template <typename Work>
Cost cost_of(ServerConnection& monitor, const Work& work) {
    const double server_s = server_cpu_s(monitor);
    const double client_s = cpu_s(), begin_s = wall_s();
    work();
    const double took_s = wall_s() - begin_s;
    return {took_s, cpu_s() - client_s, server_cpu_s(monitor) - server_s};
}

} // namespace macadam::bench
