#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace macadam {

/// Maintenance operation that changes many values, such as calibrating cars or forgetting trips.
/// The result is first computed in shadow tables while others continue to write; the write lock is
/// held only to apply it.
struct Maintenance {
    /// Creates temporary tables and views that shadow the tables of the same names, so that readers
    /// of this connection see the database as it will be.
    /// \returns  the chunks whose states change; `std::nullopt`: there is nothing to do.
    std::function<std::optional<std::vector<std::int64_t>>()> build_shadow;

    /// SQL that drops those tables and views, if they exist.
    const char* drop_shadow;

    /// Applies the operation to the database. \returns its row in the audit.
    std::function<std::int64_t()> apply;
};

/// Builds the shadow tables and fuses the affected chunks in read transactions. Then it takes the
/// write lock, checks that the input is unchanged, applies the operation, and writes the states.
/// Chunks with trips added meanwhile are fused again; after another maintenance operation,
/// everything starts over, the third time under the write lock.
///
/// \returns false if there was nothing to do.
/// \throws InputError  if a stop is requested; the database is unchanged.
bool apply_maintenance(Database& database,
                       std::int64_t segments_per_chunk,
                       const ClassTable& classes,
                       const Maintenance& maintenance,
                       const Progress& progress);

} // namespace macadam
