#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace macadam {

/// When a group of passes may be published.
struct ReleaseRule {
    std::int32_t min_cars = 5;     ///< distinct ones in every figure
    std::int32_t min_new_cars = 2; ///< since the last publication: no single car tips the scale

    /// Cars up to each of these numbers, rising, were named under another key than those after it:
    /// one car may be there under several numbers.
    std::vector<std::int64_t> last_of_key{};
};

/// How many cars these are at least: the most that were named under one key.
std::int32_t min_count(const std::set<std::int64_t>& vehicles, const ReleaseRule& rule);

/// A pass over a segment that no publication tells of yet.
struct PendingPass {
    std::int64_t vehicle;
    std::optional<std::int64_t> utc_ms;
    bool is_new;   ///< came since the last publication
    bool has_aged; ///< was there already in a publication so long ago that what came since counts
                   ///< no more
};

/// Passes that are published together: those of whole months, by at least the least number of
/// cars. Never divided and never joined later, so that the difference of any two figures ever
/// published is made of such batches.
struct ReleaseBatch {
    std::vector<std::size_t> passes;      ///< of those pending, rising
    std::optional<std::int64_t> from_ms;  ///< begin of its first month; nothing: none is dated
    std::optional<std::int64_t> until_ms; ///< end of its last one
};

struct Release {
    std::vector<ReleaseBatch> batches; ///< in the order of time
    std::vector<std::size_t> left;     ///< of the passes: those that stay pending
};

/// Groups the pending passes of a segment. A batch takes month after month, those without a date
/// first, until enough cars are in it; what is left stays pending. No batch at all, and all stay
/// pending, unless at least `min_new_cars` of the cars are new or those that aged are enough alone.
Release release(std::span<const PendingPass> pending, const ReleaseRule& rule);

/// The begin of the month of a time, UTC.
std::int64_t month_begin_ms(std::int64_t utc_ms);
std::int64_t next_month_ms(std::int64_t utc_ms); ///< the begin of the month after

} // namespace macadam
