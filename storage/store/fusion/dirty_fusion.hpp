#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/records/fusion_record.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

class StagedChunks;

/// Fuses the chunks that hold dirty segments, in the order of their keys, until all chunks that
/// were dirty at the beginning are done or a stop is requested. All segments of a chunk are fused
/// again, because a new trace may shift the others.
///
/// Chunks are processed in batches: fused in a read transaction, then written in a transaction that
/// checks that the input is unchanged. A chunk that others changed meanwhile is retried later, the
/// third time under the write lock. Other writers wait only during the writes. The result does not
/// depend on the batches, since the states of a chunk are a function of its own passes and the
/// rules of the generation.
///
/// Changes are recorded in the audit as the effect of an import.
///
/// \param record  of the earlier fusions of the same import; this one is added
/// \returns  the number of dirty segments that are now clean
std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_per_chunk,
                       const ClassTable& classes,
                       const Progress& progress,
                       FusionRecord& record);

/// Input of fuse_dirty_at_once().
struct FusionWork {
    std::int64_t segments_per_chunk;
    const ClassTable* classes;
    std::int64_t audit;             ///< audit row to which changes are attributed
    StagedChunks* staged = nullptr; ///< chunks that were fused before
};

/// Fuses all dirty chunks within the caller's transaction.
std::size_t
fuse_dirty_at_once(Database& database, const FusionWork& work, const Progress& progress);

} // namespace macadam
