#pragma once

#include "mapping/fusion/fusion.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Pass with the position of its segment.
struct ChunkPass {
    std::int64_t fid; ///< row of the segment
    FusionInput input;
    double from_m; ///< station along the way, rising in driving direction
    double to_m;
};

/// Reads the passes of chunks within one transaction, because it caches trips.
class ChunkPasses {
public:
    explicit ChunkPasses(Database& database);

    /// Passes of a chunk in the order of (row of the segment, trip hash, occurrence), without
    /// calibration.
    /// \param chunk  row of its first segment.
    std::vector<ChunkPass> of(std::int64_t chunk, std::int64_t segments_per_chunk);

private:
    struct Trip {
        std::string sha256;
        std::int64_t vehicle; ///< negative for references, unlike any car
        std::optional<std::int64_t> t0_utc_ms;
        bool reference;
        bool by_filter;
    };
    struct SegmentInterval {
        std::int64_t fid;
        SegmentKey key;
        double from_m;
        double to_m;
    };

    const Trip* trip(std::int64_t row);
    std::vector<SegmentInterval> places_of(std::int64_t chunk, std::int64_t segments_per_chunk);
    std::optional<ChunkPass> pass_at(const SegmentInterval& place);

    Statement select_trip_;
    Statement select_places_;
    Statement select_passes_;
    std::unordered_map<std::int64_t, Trip> trips_;
};

} // namespace macadam
