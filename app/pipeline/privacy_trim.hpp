#pragma once

#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/privacy/trip_trimming.hpp"
#include "storage/store/import_store.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Returns the trim rule of trips that enter a database. A crowd database draws it from its key,
/// with the requested length as minimum. Creates the key if it is missing.
TrimRule trim_in(ImportStore& store, TrimRule asked);

/// Returns the rule for one trip: inactive if its log states that the recorder left out at least as
/// much (`trimmed_m`), otherwise the rule as it is, since the log does not show where the trip
/// began.
TrimRule trim_for(const TripMeta& meta, const TrimRule& rule);

/// Parts of a trip that enter passes, traces, distances and times; the rest is discarded.
struct KeptParts {
    std::vector<TravelSpan> parts; ///< in order; empty: the trip is too short
    bool is_whole;                 ///< no part was removed
};

KeptParts kept_of(const TripLog& trip, const Odometer& odometer, const TrimRule& rule);

double length_m(const KeptParts& kept);

/// Restricts a match to the kept parts. A segment that extends beyond a cut is removed completely.
MatchedTrace trimmed(const MatchedTrace& matched, const KeptParts& kept, const RoadNetwork& roads);

/// Marks samples of one stream outside the kept parts as not used, with the reason `trimmed`.
/// \param t_s  their time stamps, `latency_s` behind the true times
SampleUse trimmed_use(SampleUse use,
                      const std::vector<double>& t_s,
                      double latency_s,
                      const Odometer& odometer,
                      const KeptParts& kept);

/// Describes the trim.
/// \param whole_m  length of the trip
std::string trim_text(const KeptParts& kept, double whole_m, const TrimRule& rule);

} // namespace macadam
