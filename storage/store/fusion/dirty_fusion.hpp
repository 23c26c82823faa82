#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

class StagedChunks;

/// Fuses the chunks that hold dirty segments, in the order of their keys, until all that there were
/// at the beginning are done or nobody wants more. Every segment of a chunk is fused anew, for a
/// new trace may move the others.
///
/// Some chunks at a time are one turn: they are fused in a transaction that only reads, and written
/// in one that looks whether what was read is still so; a chunk that others changed meanwhile comes
/// again later, and the third time is fused where nobody can. Who else wants to write waits for the
/// writing alone. What comes out does not depend on where turns are cut, since the states of a
/// chunk are a function of its own passes and of the generation's rules.
///
/// What changes is noted in the audit as the work of an import.
///
/// \returns  how many dirty segments are clean now
std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_per_chunk,
                       const ClassTable& classes,
                       const Progress& progress);

/// What fuse_dirty_at_once() is done for.
struct FusionWork {
    std::int64_t segments_per_chunk;
    const ClassTable* classes;
    std::int64_t audit;             ///< the row whose work it is
    StagedChunks* staged = nullptr; ///< chunks that were fused before
};

/// The same within the caller's transaction.
std::size_t
fuse_dirty_at_once(Database& database, const FusionWork& work, const Progress& progress);

} // namespace macadam
