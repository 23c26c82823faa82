#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Record of the fusions of one import, which may fuse several times: they share an entry in the
/// audit, and a segment counts once.
struct FusionRecord {
    std::optional<std::int64_t> audit;  ///< row of the entry; `std::nullopt`: no value changed yet
    std::vector<std::int64_t> segments; ///< rows of the segments with new passes, ascending
};

} // namespace macadam
