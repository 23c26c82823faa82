#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// A moment of a store, as far as states of segments depend on it. Between two moments of the same
/// upkeep nothing happened to passes, traces and the rules by which they are fused, but that trips
/// came in; these have rows above those of the first moment.
struct StoreVersion {
    std::int64_t maintenance; ///< row in table audit of the last thing done that was no import
    std::int64_t last_trip;   ///< row
};

StoreVersion moment_of(Database& database);

/// Chunks with passes or traces of trips that came in since, in the order of their rows. Of the
/// same upkeep.
std::vector<std::int64_t> chunks_driven_since(Database& database, const StoreVersion& before);

/// Chunks that have passes, in the order of their rows.
std::vector<std::int64_t> driven_chunks(Database& database);

/// Chunks with a segment that is dirty, or that are it themselves, in the order of their rows.
std::vector<std::int64_t> dirty_chunks(Database& database);

} // namespace macadam
