#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/fusion/measured_segment.hpp"
#include "mapping/style/iri_class.hpp"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Length of road in one class of roughness, m. `low_m` and `high_m` are the lengths if all
/// readings shared one bias as large as their common error may be (90 %).
struct ClassLengthRange {
    double length_m = 0;
    double low_m = 0;
    double high_m = 0;
};

/// Statistics of the roads of one kind, counting every drivable direction.
struct RoadSummary {
    std::string kind;     ///< one of road_kinds(); "" = all
    double network_m = 0; ///< on the map
    double covered_m = 0; ///< with at least one pass
    double thrice_m = 0;  ///< with at least three passes
    RoadMean mean{};
    double p50 = 0, p85 = 0, p95 = 0;        ///< mm/m, by length; 0 where no road is covered
    std::vector<ClassLengthRange> classes{}; ///< in the order of the class table
};

struct NetworkSummary {
    RoadSummary all;
    std::vector<RoadSummary> kinds{}; ///< kinds on the map, in the order of road_kinds()
};

/// Returns OSM's highway classes open to cars, the most important first, and "other" last.
std::span<const std::string_view> road_kinds();

/// Returns the kind of a highway tag: slip roads count with their road ("primary_link": "primary"),
/// and unknown tags are "other".
std::string_view road_kind(std::string_view highway);

/// Summarises a network.
///
/// \param network_m  metres on the map by highway tag, measured or not.
NetworkSummary network_summary(std::span<const MeasuredSegment> measured,
                               const std::map<std::string, double>& network_m,
                               const ClassTable& classes);

/// Length of road by roughness, m: bins [0, step), [step, 2 step), ..., the last one open-ended;
/// each bin holds one length per class of the table.
struct IriHistogram {
    double step_mm_per_m;
    std::vector<std::vector<double>> length_m;
};
IriHistogram iri_histogram(std::span<const MeasuredSegment> measured,
                           const ClassTable& classes,
                           double step_mm_per_m,
                           std::size_t bins);

} // namespace macadam
