#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/network/segment.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

class Area;

/// Interval of time, ms since 1970 UTC: from <= t < until. `std::nullopt`: unbounded on that side.
struct Period {
    std::optional<std::int64_t> from_ms;
    std::optional<std::int64_t> until_ms;
    friend bool operator==(const Period&, const Period&) = default;
};

/// Filter for segments; all conditions must hold.
struct SegmentFilter {
    std::optional<GeoBox> box; ///< its east may lie beyond 180 degrees, over the antimeridian
    std::optional<std::int64_t> way_id;
    std::optional<SegmentKey> key;
    std::string name_part;       ///< substring of the road's name, ignoring case; "" = any
    bool with_state_only = true; ///< false: also segments without a pass
    std::size_t worst = 0;       ///< n > 0: only the n segments with the highest iri, highest first

    std::optional<std::vector<SegmentRange>> ranges{}; ///< only these, in this order
    std::string highway{};                             ///< OSM highway class; "" = any
    std::string class_name{};       ///< of the database's class table; "" = any class or none
    std::int32_t min_passes = 0;    ///< > 0: excludes segments without a pass
    std::optional<Period> period{}; ///< fuses states only from passes dated within it
    bool cars_alone = false;        ///< fuses states only from passes of cars, without references
    std::shared_ptr<const Area> area{}; ///< null: everywhere
    std::int32_t min_vehicles = 0;      ///< > 0: excludes segments without a pass
    std::string vehicle{}; ///< pseudonym: fuses states only from passes of this car; "" = all cars
};

/// Amount of detail in the states given to visit(); less is faster.
enum class StateDetail {
    full,
    tiles, ///< for tiles: without IRI per track, uncertainty of the trend, and change
};

} // namespace macadam
