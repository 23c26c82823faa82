#include "storage/store/fusion/chunk_events.hpp"

#include "storage/store/rows/event_row.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {
namespace {

constexpr double mm_per_m = 1000;

/// Appends the segment of a pass, or the pass to it if it is the last one.
void add_searched(const ChunkPass& pass, std::vector<SearchedSegment>& segments) {
    const auto& key = pass.input.pass.segment;
    if (segments.empty() || segments.back().key != key) {
        segments.push_back({key, pass.from_m, pass.to_m, {}});
    }
    segments.back().passes_utc_ms.push_back(pass.input.utc_ms);
}

bool saw_elevations(const Pass& pass) {
    return (pass.validity & validity::lateral_alone) == 0;
}

} // namespace

ChunkEvents::ChunkEvents(Database& database)
    : database_{&database}, traces_{database},
      select_trip_{database.prepare("SELECT trip.id FROM trip CROSS JOIN event_search AS search"
                                    " ON search.trip = trip.id WHERE trip.sha256 = ?")},
      select_events_{database.prepare(fmt::format("SELECT {} FROM event WHERE segment = ?"
                                                  " AND trip = ? AND occurrence = ?"
                                                  " ORDER BY number",
                                                  event_columns))} {}

void ChunkEvents::add(std::int64_t chunk, std::span<const ChunkPass> passes, EventInputs& inputs) {
    const auto before = inputs.reports.size();
    std::vector<std::size_t> pass_of; // of each new report
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const auto trip = searched_trip(passes[i].input.trip_sha256);
        if (!trip || !saw_elevations(passes[i].input.pass)) {
            continue;
        }
        add_searched(passes[i], inputs.segments);
        add_reports(passes[i], *trip, inputs.reports);
        pass_of.resize(inputs.reports.size() - before, i);
    }
    if (pass_of.size() > 1) {
        align(chunk, passes, std::span{inputs.reports}.subspan(before), pass_of);
    }
}

std::optional<std::int64_t> ChunkEvents::searched_trip(const std::string& sha256) {
    const auto [found, is_new] = trips_.try_emplace(sha256);
    if (is_new && select_trip_.bind(sha256).step()) {
        found->second = select_trip_.integer(0);
    }
    select_trip_.reset();
    return found->second;
}

void ChunkEvents::add_reports(const ChunkPass& pass,
                              std::int64_t trip,
                              std::vector<EventReport>& reports) {
    const auto& segment = pass.input.pass.segment;
    const auto occurrence = pass.input.pass.occurrence;
    select_events_.bind(pass.fid, trip, std::int64_t{occurrence});
    while (select_events_.step()) {
        auto event = event_in(*database_, select_events_, 0, segment, occurrence);
        const double along_m = static_cast<double>(event.at_mm) / mm_per_m;
        reports.push_back({.event = event,
                           .station_m = station_m(segment.forward, along_m),
                           .trip = trip,
                           .vehicle = pass.input.vehicle,
                           .utc_ms = pass.input.utc_ms});
    }
    select_events_.reset();
}

void ChunkEvents::align(std::int64_t chunk,
                        std::span<const ChunkPass> passes,
                        std::span<EventReport> reports,
                        std::span<const std::size_t> pass_of) {
    const auto traces = traces_.placed(chunk, drives_of(passes));
    for (std::size_t i = 0; i < reports.size(); ++i) {
        const auto& input = passes[pass_of[i]].input;
        if (const auto* placed = find_trace(traces, input.trip_sha256, input.pass.drive)) {
            // What the trip read at station s + lag belongs to s; lags change by millimetres a
            // metre.
            reports[i].station_m -= lag_m(placed->lag, reports[i].station_m);
        }
    }
}

WayEvents::WayEvents(Database& database, std::int64_t segments_per_chunk, const PassChoice& choice)
    : chunks_{database}, events_{database},
      select_chunks_{database.prepare("SELECT DISTINCT segment.strip FROM segment CROSS JOIN"
                                      " event ON event.segment = segment.fid"
                                      " WHERE way_id = ? AND direction = ? ORDER BY 1")},
      segments_per_chunk_{segments_per_chunk}, choice_{choice} {}

std::vector<FusedEvent> WayEvents::of(std::int64_t way_id, bool forward) {
    EventInputs inputs;
    select_chunks_.bind(way_id, forward ? "forward" : "backward");
    while (select_chunks_.step()) {
        const auto chunk = select_chunks_.integer(0);
        events_.add(chunk, chunks_.passes(chunk, segments_per_chunk_, choice_), inputs);
    }
    select_chunks_.reset();
    return fuse_events(std::move(inputs.reports), inputs.segments);
}

} // namespace macadam
