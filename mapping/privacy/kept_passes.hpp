#pragma once

#include "estimator/common/geo.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// A segment that a trip passed, as a database knows it that keeps no positions.
struct PassedSegment {
    std::int64_t t_ms; ///< middle of the passage
    double length_m;
    GeoPoint from; ///< of the segment, in driving direction
    GeoPoint to;
};

/// Which passes of a trip stay when its ends and long stops are trimmed after the fact.
///
/// Where the trip began before its first pass, nobody knows any more: lengths count from there,
/// which leaves out more than needed. So does each pause of more than five minutes between two
/// passes, whether the car stood or drove elsewhere.
///
/// \param passed  in driving order
/// \param draw_m  length number n: drawn for this trip, always the same
std::vector<bool> kept_passes(std::span<const PassedSegment> passed,
                              const std::function<double(std::size_t n)>& draw_m);

} // namespace macadam
