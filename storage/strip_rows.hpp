#pragma once

#include "mapping/alignment.hpp"
#include "mapping/strip_trace.hpp"
#include "storage/sqlite.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam {

/// A trace of a store and where it lies among the others of its strip.
struct PlacedTrace {
    std::string trip_sha256;
    StripTrace trace;
    LagLine lag;
};

/// Which drives: trip hash and drive.
using DriveSet = std::set<std::pair<std::string, std::uint32_t>>;

/// The traces of strips, each laid on the others of its own.
class StripTraces {
public:
    explicit StripTraces(Database& database);

    /// In the order of (trip hash, drive); `strip` is the row of its first segment.
    ///
    /// \throws InputError  if a trace is none; the store was changed.
    std::vector<PlacedTrace> placed(std::int64_t strip);

    /// The same of these drives alone, as if there were no others.
    std::vector<PlacedTrace> placed(std::int64_t strip, const DriveSet& drives);

private:
    std::vector<PlacedTrace> unplaced(std::int64_t strip);

    const Database* database_;
    Statement select_;
};

/// Null if there is none.
const PlacedTrace* find_trace(std::span<const PlacedTrace> traces,
                              const std::string& trip_sha256,
                              const std::optional<std::uint32_t>& drive);

} // namespace macadam
