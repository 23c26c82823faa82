#pragma once

#include "mapping/fusion/fusion.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace macadam {

/// A pass and where its segment lies.
struct ChunkPass {
    std::int64_t fid; ///< the segment's row
    FusionInput input;
    double from_m; ///< station: along the way, rising in driving direction
    double to_m;
};

/// Reads the passes of chunks. For one transaction: trips that it has seen are not read again.
class ChunkPasses {
public:
    explicit ChunkPasses(Database& database);

    /// In the order of (row of the segment, trip hash, occurrence), none calibrated.
    /// \param chunk  the row of its first segment.
    std::vector<ChunkPass> of(std::int64_t chunk, std::int64_t segments_per_chunk);

private:
    struct Trip {
        std::string sha256;
        std::int64_t vehicle; ///< of a reference none: below 0, where no car's is
        std::optional<std::int64_t> t0_utc_ms;
        bool reference;
    };
    struct Place {
        std::int64_t fid;
        SegmentKey key;
        double from_m;
        double to_m;
    };

    const Trip* trip(std::int64_t row);
    std::vector<Place> places_of(std::int64_t chunk, std::int64_t segments_per_chunk);
    std::optional<ChunkPass> pass_at(const Place& place);

    Statement select_trip_;
    Statement select_places_;
    Statement select_passes_;
    std::unordered_map<std::int64_t, Trip> trips_;
};

} // namespace macadam
