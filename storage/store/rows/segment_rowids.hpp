#pragma once

#include "mapping/passes/chunk_trace.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Maps segment keys to rows. Looks up whole chunks, because a trip visits neighbouring segments,
/// and caches them for later trips.
class SegmentRowids {
public:
    SegmentRowids(Database& database, std::int64_t segments_per_chunk);

    /// \throws InputError  for a segment that the database does not contain.
    std::int64_t row_of(const SegmentKey& segment);

    /// Row of the first segment of a chunk. \throws InputError  for a chunk that the database does
    /// not contain.
    std::int64_t row_of(const ChunkKey& chunk);

private:
    struct Hash {
        std::size_t operator()(const ChunkKey& key) const;
    };
    using Rows =
        std::vector<std::int64_t>; ///< rows of segments by their index; 0 = no such segment

    const Rows& rows_of(const ChunkKey& chunk);

    Database* database_;
    Statement select_;
    std::int64_t segments_in_chunk_;
    std::unordered_map<ChunkKey, Rows, Hash> known_;
};

} // namespace macadam
