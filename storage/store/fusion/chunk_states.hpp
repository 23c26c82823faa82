#pragma once

#include "mapping/fusion/fusion.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/fusion/chunk_passes.hpp"
#include "storage/store/fusion/chunk_trace_rows.hpp"
#include "storage/store/fusion/fusion_settings.hpp"
#include "storage/store/schema/segment_filter.hpp"
#include "storage/store/schema/store_records.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace macadam {

struct FusedSegment {
    std::int64_t fid;
    SegmentState state;
};

struct FusedChunk {
    AlignmentSummary laid;              ///< of its traces
    std::vector<FusedSegment> segments; ///< with a pass, in the order of their rows
};

/// Which passes a state is fused from.
struct PassChoice {
    std::optional<Period> period; ///< those with a date in it
    bool cars_alone;              ///< those of references are left out
};

/// States of the segments of chunks, fused from their passes, which are first laid on each other,
/// by the rules that the store has when this is made.
class ChunkFusion {
public:
    explicit ChunkFusion(Database& database);

    /// \param chunk  the row of its first segment.
    FusedChunk of(std::int64_t chunk, std::int64_t segments_per_chunk);

    /// Its segments from some passes alone, as if there were no others.
    std::vector<FusedSegment>
    of(std::int64_t chunk, std::int64_t segments_per_chunk, const PassChoice& choice);

    /// The passes of these trips, by hash, where they lie among each other; as they were read,
    /// whatever is known of their cars, and also those of a road that is no more.
    std::vector<ChunkPass> readings(std::int64_t chunk,
                                    std::int64_t segments_per_chunk,
                                    const std::unordered_set<std::string>& trips);

    /// The passes of cars from which states are fused, where their own trips put them.
    std::vector<ChunkPass> passes_of_cars(std::int64_t chunk, std::int64_t segments_per_chunk);

    /// Takes them to where they lie among each other, as if there were no others.
    void align_with_each_other(std::int64_t chunk, std::vector<ChunkPass>& passes);

    const FusionConfig& config() const { return config_; }

private:
    std::vector<ChunkPass> valid_passes(std::int64_t chunk, std::int64_t segments_per_chunk);

    ChunkTraces traces_;
    ChunkPasses passes_;
    ValidFrom valid_from_;
    CarRecords cars_;
    FusionConfig config_;
};

} // namespace macadam
