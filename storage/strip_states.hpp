#pragma once

#include "mapping/fusion.hpp"
#include "storage/road_store.hpp"
#include "storage/sqlite.hpp"
#include "storage/strip_rows.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

struct FusedSegment {
    std::int64_t fid;
    SegmentState state;
};

struct FusedStrip {
    std::vector<LagLine> lags;          ///< of its traces, in the order of (trip hash, drive)
    std::vector<FusedSegment> segments; ///< with a pass, in the order of their rows
};

/// States of the segments of strips, fused from their passes, which are first laid on each other.
class StripStates {
public:
    StripStates(Database& database, const FusionConfig& config);

    /// \param strip  the row of its first segment.
    FusedStrip of(std::int64_t strip, std::int64_t segments_in_strip);

    /// Its segments from the dated passes of a period alone, as if there were no others.
    std::vector<FusedSegment>
    of(std::int64_t strip, std::int64_t segments_in_strip, const Period& period);

private:
    StripTraces traces_;
    Statement select_;
    FusionConfig config_;
};

} // namespace macadam
