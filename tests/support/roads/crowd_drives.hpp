#pragma once

#include "mapping/network/road_network.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstdint>
#include <vector>

namespace macadam::testing {

// Drives of many cars over the same roads.

inline constexpr std::int64_t day_ms = 86'400'000;
inline constexpr std::int64_t january_ms = 1'767'225'600'000; // 2026-01-01
inline constexpr std::int64_t february_ms = january_ms + 31 * day_ms;
inline constexpr std::int64_t march_ms = february_ms + 28 * day_ms;
inline constexpr std::int64_t april_ms = march_ms + 31 * day_ms;

/// Roads 1, 2, ... of 200 m each, one after the other; of who drives them all, the first and the
/// last are not published.
RoadNetwork roads_in_a_row(int roads);

/// Drive of a car over all of them.
struct CrowdDrive {
    int number; ///< another one for each drive
    int car;
    std::int64_t utc_ms;
    IriUm iri_um = 2000;
    bool reports_holes = false; ///< at 55 m of roads 1 and 2
    int roads = 3;
    int first_road = 1; ///< of these

    TripRecord record() const;
    std::vector<Pass> passes() const;
    std::vector<PassEvent> events() const;
};

} // namespace macadam::testing
