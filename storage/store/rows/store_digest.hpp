#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace macadam {

/// Rows of the segments of a chunk, which are consecutive.
struct ChunkRows {
    std::int64_t first;
    std::int64_t last;
};

/// Computes the SHA-256 over passes and states as text (docs/reference/database.md), for any
/// version of the database. Consistent only within a transaction. `progress` counts rows.
///
/// \throws InputError  also if `progress` is told to stop.
std::string digest_of(Database& database, const Progress& progress);

/// Computes the digest of some chunks, in the order of their keys, and of the trips that drove
/// there.
std::string
digest_of(Database& database, const Progress& progress, std::span<const ChunkRows> chunks);

} // namespace macadam
