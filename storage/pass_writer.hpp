#pragma once

#include "mapping/pass.hpp"
#include "mapping/strip_trace.hpp"
#include "storage/bulk_insert.hpp"
#include "storage/sqlite.hpp"
#include "storage/strip_segments.hpp"

#include <cstdint>
#include <span>
#include <unordered_set>

namespace macadam {

/// Where passes and traces of trips are written.
enum class Destination {
    kept,  ///< in the store
    staged ///< aside, in temporary tables of the connection (storage/road_store_reprocess.cpp)
};

/// Writes passes and traces of trips, and, where they are to be kept, marks their segments and
/// strips as not fused yet. For one transaction: what it has looked up may change between two.
class PassWriter {
public:
    PassWriter(Database& database, std::int64_t segments_in_strip, Destination destination);

    /// \param trip  its row.
    /// \throws InputError  for a segment or a strip that the store does not have.
    void write(std::int64_t trip, std::span<const Pass> passes, std::span<const StripTrace> traces);

    /// To be called before the commit: rows of passes wait to be written together.
    void flush();

private:
    void write_pass(std::int64_t segment, std::int64_t trip, const Pass& pass);
    void write_trace(std::int64_t strip, std::int64_t trip, const StripTrace& trace);

    bool marks_;
    StripSegments segments_;
    BulkInsert add_pass_;
    Statement add_trace_;
    BulkInsert mark_segment_;
    BulkInsert mark_strip_;
    std::unordered_set<std::int64_t> marked_segments_; ///< rows
    std::unordered_set<std::int64_t> marked_strips_;   ///< rows
};

} // namespace macadam
