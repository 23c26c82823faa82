#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/network/segment.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// A span of time, ms since 1970 UTC: from <= t < until. Nothing: open on that side.
struct Period {
    std::optional<std::int64_t> from_ms;
    std::optional<std::int64_t> until_ms;
    friend bool operator==(const Period&, const Period&) = default;
};

/// Which segments to visit; all conditions hold together.
struct SegmentFilter {
    std::optional<GeoBox> box;
    std::optional<std::int64_t> way_id;
    std::optional<SegmentKey> key;
    std::string name_part;       ///< of the road's name, any case; "" = any
    bool with_state_only = true; ///< false: also those without a pass
    std::size_t worst = 0;       ///< n > 0: only the n with the highest iri, highest first

    std::optional<std::vector<SegmentRange>> ranges{}; ///< only these, in this order
    std::string highway{};                             ///< OSM's class of the road; "" = any
    std::string class_name{};       ///< of the store's class table; "" = any, and none
    std::int32_t min_passes = 0;    ///< more than 0: segments without a pass are left out
    std::optional<Period> period{}; ///< states of the dated passes of that time alone
    bool cars_alone = false;        ///< states of cars' passes alone, without references
};

/// How much visit() tells of a state: each number takes its time.
enum class StateDetail {
    full,
    tiles, ///< what tiles show: not each track's IRI, the trend's uncertainty and the change
};

} // namespace macadam
