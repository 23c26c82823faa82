#pragma once

#include "estimator/common/geo.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// A segment passed by a trip, as recorded in a database without positions.
struct PassedSegment {
    std::int64_t t_ms; ///< middle of the pass
    double length_m;
    GeoPoint from; ///< start of the segment, in driving direction
    GeoPoint to;
};

/// Selects the passes of a trip that remain when its ends and long stops are trimmed after import.
///
/// The start of the trip before its first pass is no longer known, so lengths count from that pass,
/// which removes more than necessary. Each pause of more than five minutes between two passes is
/// treated alike, whether the car stood or drove elsewhere.
///
/// \param passed  in driving order
/// \param draw_m  length number n of this trip, random but reproducible
std::vector<bool> kept_passes(std::span<const PassedSegment> passed,
                              const std::function<double(std::size_t n)>& draw_m);

} // namespace macadam
