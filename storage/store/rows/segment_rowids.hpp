#pragma once

#include "mapping/passes/chunk_trace.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Rows of segments by their keys. Looked up a chunk at a time, for a trip drives one after the
/// other, and kept for the trips that follow it.
class SegmentRowids {
public:
    SegmentRowids(Database& database, std::int64_t segments_per_chunk);

    /// \throws InputError  for one that the store does not have.
    std::int64_t row_of(const SegmentKey& segment);

    /// The row of its first segment. \throws InputError  for one that the store does not have.
    std::int64_t row_of(const ChunkKey& chunk);

private:
    struct Hash {
        std::size_t operator()(const ChunkKey& key) const;
    };
    using Rows = std::vector<std::int64_t>; ///< of segments by their number; 0 = there is none

    const Rows& rows_of(const ChunkKey& chunk);

    Database* database_;
    Statement select_;
    std::int64_t segments_in_chunk_;
    std::unordered_map<ChunkKey, Rows, Hash> known_;
};

} // namespace macadam
