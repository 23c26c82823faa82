#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/iri_class.hpp"
#include "storage/sqlite.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

class StagedStrips;

/// Fuses the strips that hold dirty segments, in the order of their keys, until all that there were
/// at the beginning are done or nobody wants more. Every segment of a strip is fused anew, for a
/// new trace may move the others.
///
/// Some strips at a time are one turn: they are fused in a transaction that only reads, and written
/// in one that looks whether what was read is still so; a strip that others changed meanwhile comes
/// again later, and the third time is fused where nobody can. Who else wants to write waits for the
/// writing alone. What comes out does not depend on where turns are cut, since the states of a
/// strip are a function of its own passes and of the generation's rules.
///
/// What changes is noted in the audit as the work of an import.
///
/// \returns  how many dirty segments are clean now
std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_in_strip,
                       const ClassTable& classes,
                       const Progress& progress);

/// What fuse_dirty_at_once() is done for.
struct FusionWork {
    std::int64_t segments_in_strip;
    const ClassTable* classes;
    std::int64_t audit;             ///< the row whose work it is
    StagedStrips* staged = nullptr; ///< strips that were fused before
};

/// The same within the caller's transaction.
std::size_t
fuse_dirty_at_once(Database& database, const FusionWork& work, const Progress& progress);

} // namespace macadam
