#pragma once

#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/privacy/trip_trimming.hpp"
#include "storage/store/road_store.hpp"

#include <string>
#include <vector>

namespace macadam {

/// How trips that come into a store are trimmed: those of a crowd as its key draws it, and by what
/// was asked for where that is more. Makes the key if it is missing.
TrimRule trim_in(RoadStore& store, TrimRule asked);

/// Parts of a trip that enter passes, traces, distances and times; nothing of the rest is kept.
struct KeptParts {
    std::vector<TravelSpan> parts; ///< in order; empty: the trip is too short
    bool is_whole;                 ///< nothing was left out
};

KeptParts kept_of(const TripLog& trip, const Odometer& odometer, const TrimRule& rule);

double length_m(const KeptParts& kept);

/// The match within these parts. A segment that reaches out of one where it was cut is left out
/// whole.
MatchedTrace trimmed(const MatchedTrace& matched, const KeptParts& kept, const RoadNetwork& roads);

/// Readings of vibration and rotation outside these parts count as not used, for the reason
/// `trimmed`.
RowAudit without_vibration_outside(RowAudit use,
                                   const TripLog& trip,
                                   const Odometer& odometer,
                                   const KeptParts& kept);

/// The same of speeds and fixes.
RowAudit without_places_outside(RowAudit use,
                                const TripLog& trip,
                                const Odometer& odometer,
                                const KeptParts& kept);

/// What to say of it. \param whole_m  of the trip
std::string trim_text(const KeptParts& kept, double whole_m, const TrimRule& rule);

} // namespace macadam
