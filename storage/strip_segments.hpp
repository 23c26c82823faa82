#pragma once

#include "mapping/strip_trace.hpp"
#include "storage/sqlite.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Rows of segments by their keys. Looked up a strip at a time, for a trip drives one after the
/// other, and kept for the trips that follow it.
class StripSegments {
public:
    StripSegments(Database& database, std::int64_t segments_in_strip);

    /// \throws InputError  for one that the store does not have.
    std::int64_t row_of(const SegmentKey& segment);

    /// The row of its first segment. \throws InputError  for one that the store does not have.
    std::int64_t row_of(const StripKey& strip);

private:
    struct Hash {
        std::size_t operator()(const StripKey& key) const;
    };
    using Rows = std::vector<std::int64_t>; ///< of segments by their number; 0 = there is none

    const Rows& rows_of(const StripKey& strip);

    Database* database_;
    Statement select_;
    std::int64_t segments_in_strip_;
    std::unordered_map<StripKey, Rows, Hash> known_;
};

} // namespace macadam
