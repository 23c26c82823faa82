#pragma once

#include "mapping/alignment/alignment.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam {

/// Trace of the database with its alignment within its chunk.
struct AlignedTrace {
    std::string trip_sha256;
    RoughnessTrace trace;
    LagLine lag;
};

/// Set of drives, each a trip hash and the number of a drive.
using DriveSet = std::set<std::pair<std::string, std::uint32_t>>;

/// Reads the traces of chunks, aligned within each chunk.
class ChunkTraces {
public:
    explicit ChunkTraces(Database& database);

    /// Returns the aligned traces in the order of (trip hash, drive).
    ///
    /// \param chunk  row of its first segment.
    /// \throws InputError  if a trace is invalid, because the database was modified.
    std::vector<AlignedTrace> placed(std::int64_t chunk);

    /// Returns the traces of these drives, aligned as if there were no others.
    std::vector<AlignedTrace> placed(std::int64_t chunk, const DriveSet& drives);

private:
    std::vector<AlignedTrace> unplaced(std::int64_t chunk);

    const Database* database_;
    Statement select_;
};

/// Trace of a drive; null if there is none.
const AlignedTrace* find_trace(std::span<const AlignedTrace> traces,
                               const std::string& trip_sha256,
                               const std::optional<std::uint32_t>& drive);

} // namespace macadam
