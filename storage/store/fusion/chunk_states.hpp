#pragma once

#include "mapping/fusion/fusion.hpp"
#include "mapping/fusion/trip_limit.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/fusion/chunk_passes.hpp"
#include "storage/store/fusion/chunk_trace_rows.hpp"
#include "storage/store/fusion/fusion_settings.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

namespace macadam {

struct FusedSegment {
    std::int64_t fid;
    SegmentState state;
};

struct FusedChunk {
    AlignmentSummary alignment;         ///< of its traces
    std::vector<FusedSegment> segments; ///< those with passes, in the order of their rows
};

/// Selection of the passes from which a state is fused.
struct PassChoice {
    std::optional<Period> period;          ///< only dated passes within it
    bool cars_alone;                       ///< without references
    std::optional<std::int64_t> vehicle{}; ///< row of a car: only its passes
};

/// Drives of passes.
DriveSet drives_of(std::span<const ChunkPass> passes);

/// Aligns and fuses the passes of chunks into segment states, by the rules that the database has at
/// construction.
class ChunkFusion {
public:
    explicit ChunkFusion(Database& database);

    /// States of a chunk. \param chunk  row of its first segment.
    FusedChunk of(std::int64_t chunk, std::int64_t segments_per_chunk);

    /// States from a selection of passes, as if there were no others.
    std::vector<FusedSegment>
    of(std::int64_t chunk, std::int64_t segments_per_chunk, const PassChoice& choice);

    /// Passes of a selection that count, at the positions from their own trips.
    std::vector<ChunkPass>
    passes(std::int64_t chunk, std::int64_t segments_per_chunk, const PassChoice& choice);

    /// Aligned passes of these trips, given by hash; uncalibrated, and including passes of a former
    /// surface.
    std::vector<ChunkPass> readings(std::int64_t chunk,
                                    std::int64_t segments_per_chunk,
                                    const std::unordered_set<std::string>& trips);

    /// Passes of cars that enter the states, at the positions from their own trips.
    std::vector<ChunkPass> passes_of_cars(std::int64_t chunk, std::int64_t segments_per_chunk);

    /// Aligns passes with each other, as if there were no others.
    void align_with_each_other(std::int64_t chunk, std::vector<ChunkPass>& passes);

    const FusionConfig& config() const { return config_; }

private:
    std::vector<ChunkPass> valid_passes(std::int64_t chunk, std::int64_t segments_per_chunk);
    void keep_limited(std::vector<ChunkPass>& passes);

    ChunkTraces traces_;
    ChunkPasses passes_;
    ValidFrom valid_from_;
    CarRecords cars_;
    FusionConfig config_;
    TripLimit limit_;
};

} // namespace macadam
