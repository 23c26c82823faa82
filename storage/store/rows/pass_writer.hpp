#pragma once

#include "mapping/events/pass_event.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/rows/segment_rowids.hpp"

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

namespace macadam {

/// Tables into which passes and traces are written.
enum class Destination {
    kept,  ///< permanent tables
    staged ///< temporary tables of the connection (storage/store/maintenance/reprocess.cpp)
};

/// Event with its number within its pass, from 0.
struct NumberedEvent {
    std::int64_t number;
    PassEvent event;
};

/// Numbers the events of each pass in the order along the way.
std::vector<NumberedEvent> numbered_events(std::span<const PassEvent> events);

/// Writes passes, traces and events of trips and, in permanent tables, marks their segments and
/// chunks as dirty. Use it within one transaction, because it caches look-ups.
class PassWriter {
public:
    PassWriter(Database& database, std::int64_t segments_per_chunk, Destination destination);

    /// \param trip  row of the trip.
    /// \throws InputError  for a segment or a chunk that the database does not contain.
    void write(std::int64_t trip,
               std::span<const Pass> passes,
               std::span<const RoughnessTrace> traces,
               std::span<const PassEvent> events = {});

    /// Writes the buffered rows; call it before the commit.
    void flush();

private:
    void write_pass(std::int64_t segment, std::int64_t trip, const Pass& pass);
    void write_events(std::int64_t trip, std::span<const PassEvent> events);
    void write_trace(std::int64_t chunk, std::int64_t trip, const RoughnessTrace& trace);

    bool marks_;
    SegmentRowids segments_;
    BulkInsert add_pass_;
    Statement add_trace_;
    BulkInsert add_event_;
    BulkInsert mark_segment_;
    BulkInsert mark_chunk_;
    std::unordered_set<std::int64_t> marked_segments_; ///< rows of table segment
    std::unordered_set<std::int64_t> marked_chunks_;   ///< rows of the chunks
};

} // namespace macadam
