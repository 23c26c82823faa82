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

/// A trace of a store and where it lies among the others of its chunk.
struct PlacedTrace {
    std::string trip_sha256;
    RoughnessTrace trace;
    LagLine lag;
};

/// Which drives: trip hash and drive.
using DriveSet = std::set<std::pair<std::string, std::uint32_t>>;

/// The traces of chunks, each laid on the others of its own.
class ChunkTraces {
public:
    explicit ChunkTraces(Database& database);

    /// In the order of (trip hash, drive); `chunk` is the row of its first segment.
    ///
    /// \throws InputError  if a trace is none; the store was changed.
    std::vector<PlacedTrace> placed(std::int64_t chunk);

    /// The same of these drives alone, as if there were no others.
    std::vector<PlacedTrace> placed(std::int64_t chunk, const DriveSet& drives);

private:
    std::vector<PlacedTrace> unplaced(std::int64_t chunk);

    const Database* database_;
    Statement select_;
};

/// Null if there is none.
const PlacedTrace* find_trace(std::span<const PlacedTrace> traces,
                              const std::string& trip_sha256,
                              const std::optional<std::uint32_t>& drive);

} // namespace macadam
