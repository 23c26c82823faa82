#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace macadam {

/// Something that is done to a store and moves many numbers: cars are calibrated, trips forgotten.
/// First it is foreseen beside the store, while others go on writing; only to put it in place, it
/// keeps them from it.
struct Maintenance {
    /// Looks at the store as it is and makes temporary tables and views that hide those of the
    /// store of the same name, so that who reads these reads the store as it will be.
    /// \returns  the chunks whose states change by it; nothing: there is nothing to be done.
    std::function<std::optional<std::vector<std::int64_t>>()> build_shadow;

    /// SQL that takes those tables and views away, also if they are not there.
    const char* drop_shadow;

    /// Does to the store what was foreseen. \returns its row in the audit.
    std::function<std::int64_t()> apply;
};

/// Foresees, and fuses the chunks as they will be, in transactions that only read. Then it keeps
/// others from writing, looks whether what it read is still so, applies, and puts the states in
/// place. Chunks that trips drove over meanwhile are fused again; where another upkeep was quicker,
/// all begins anew, and the third time under the lock.
///
/// \returns false if there was nothing to be done.
/// \throws InputError  if a stop is requested; the store is as it was.
bool apply_maintenance(Database& database,
                       std::int64_t segments_per_chunk,
                       const ClassTable& classes,
                       const Maintenance& maintenance,
                       const Progress& progress);

} // namespace macadam
