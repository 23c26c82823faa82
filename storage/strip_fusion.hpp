#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/iri_class.hpp"
#include "storage/sqlite.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

/// Fuses the strips that hold dirty segments, in the order of their keys, until all that there were
/// at the beginning are done or nobody wants more. Every segment of a strip is fused anew, for a
/// new trace may move the others.
///
/// Some strips at a time are one transaction, with pauses between them: who else wants to write
/// waits a moment and not until all are done. What comes out does not depend on where they are cut,
/// since the states of a strip are a function of its own passes and of the generation's rules.
///
/// What changes is noted in the audit as the work of an import.
///
/// \returns  how many dirty segments are clean now
std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_in_strip,
                       const ClassTable& classes,
                       const Progress& progress);

/// The same within the caller's transaction, as the work of that audit's row.
std::size_t fuse_dirty_at_once(Database& database,
                               std::int64_t segments_in_strip,
                               const ClassTable& classes,
                               std::int64_t audit,
                               const Progress& progress);

} // namespace macadam
