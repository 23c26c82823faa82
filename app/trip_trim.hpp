#pragma once

#include "estimator/odometer.hpp"
#include "estimator/stretch.hpp"
#include "mapping/map_match.hpp"

#include <string>

namespace macadam {

/// What of a trip may be told when `trim_m` of travel are left out at both ends, so that nobody
/// learns where it began; all of it if trim_m is 0. Empty (from_m >= to_m) for a trip that is too
/// short.
TravelSpan told_part(const Odometer& odometer, double trim_m);

/// The match within that part. A segment that reaches out of it where it was cut is left out whole.
MatchedTrace trimmed(MatchedTrace matched, const TravelSpan& told, const RoadNetwork& roads);

/// Readings of vibration and rotation outside that part count as not used, for the reason
/// `trimmed`.
TripUse without_vibration_outside(TripUse use,
                                  const TripLog& trip,
                                  const Odometer& odometer,
                                  double trim_m);

/// The same of speeds and fixes.
TripUse
without_places_outside(TripUse use, const TripLog& trip, const Odometer& odometer, double trim_m);

/// What to say of it.
std::string spoken_trim(const TravelSpan& told, double trim_m);

} // namespace macadam
