#pragma once

#include "mapping/events/event_fusion.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/fusion/chunk_states.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Input of fuse_events() from one chunk or several.
struct EventInputs {
    std::vector<EventReport> reports;
    std::vector<SearchedSegment> segments;
};

/// Reads the events of chunks at their aligned places. Use it within one transaction, because it
/// caches trips.
class ChunkEvents {
public:
    explicit ChunkEvents(Database& database);

    /// Appends the events that these passes report, and the segments with their searched passes.
    ///
    /// \param chunk   row of its first segment
    /// \param passes  of the chunk, in the order of ChunkPasses::of()
    void add(std::int64_t chunk, std::span<const ChunkPass> passes, EventInputs& inputs);

private:
    /// Row of a trip that was searched for events; `std::nullopt` for others.
    std::optional<std::int64_t> searched_trip(const std::string& sha256);

    /// Appends the events of one pass, at the places of its trip.
    void add_reports(const ChunkPass& pass, std::int64_t trip, std::vector<EventReport>& reports);

    void align(std::int64_t chunk,
               std::span<const ChunkPass> passes,
               std::span<EventReport> reports,
               std::span<const std::size_t> pass_of);

    const Database* database_;
    ChunkTraces traces_;
    Statement select_trip_;
    Statement select_events_;
    std::unordered_map<std::string, std::optional<std::int64_t>> trips_; ///< by hash
};

/// Fuses the events on one direction of a way, from a selection of passes of cars.
class WayEvents {
public:
    WayEvents(Database& database, std::int64_t segments_per_chunk, const PassChoice& choice);

    std::vector<FusedEvent> of(std::int64_t way_id, bool forward);

private:
    ChunkFusion chunks_;
    ChunkEvents events_;
    Statement select_chunks_;
    std::int64_t segments_per_chunk_;
    PassChoice choice_;
};

} // namespace macadam
