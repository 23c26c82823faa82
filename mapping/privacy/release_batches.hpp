#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace macadam {

/// Conditions for publishing a group of passes.
struct ReleaseRule {
    std::int32_t min_cars = 5;     ///< distinct cars in every figure
    std::int32_t min_new_cars = 2; ///< since the last publication: no single car is decisive

    /// Last car number of each earlier naming key, ascending. Keys name cars differently, so one
    /// car may have several numbers.
    std::vector<std::int64_t> last_of_key{};
};

/// Returns a lower bound of the number of distinct cars: the maximum named under one key.
std::int32_t min_count(const std::set<std::int64_t>& vehicles, const ReleaseRule& rule);

/// A pass over a segment that is not yet published.
struct PendingPass {
    std::int64_t vehicle;
    std::optional<std::int64_t> utc_ms;
    bool is_new;   ///< imported since the last publication
    bool has_aged; ///< already pending at a publication so long ago that newer passes no longer
                   ///< count
};

/// Passes that are published together: those of whole months, from at least the minimum number of
/// cars. Batches are never divided or joined later, so that the difference of any two published
/// figures consists of batches.
struct ReleaseBatch {
    std::vector<std::size_t> passes; ///< indices of pending passes, ascending
    std::optional<std::int64_t>
        from_ms; ///< start of its first month; `std::nullopt`: none is dated
    std::optional<std::int64_t> until_ms; ///< end of its last month
};

struct Release {
    std::vector<ReleaseBatch> batches; ///< in order of time
    std::vector<std::size_t> left;     ///< indices of passes that stay pending
};

/// Groups the pending passes of a segment. A batch takes month after month, undated passes first,
/// until it has enough cars; the rest stays pending. Without at least `min_new_cars` new cars, or
/// enough aged cars alone, no batch is formed and all passes stay pending.
Release release(std::span<const PendingPass> pending, const ReleaseRule& rule);

} // namespace macadam
