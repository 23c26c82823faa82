#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/style/iri_class.hpp"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Road in one class of roughness, m; `low_m` and `high_m`: what it would be if all readings were
/// too high, or too low, together, by as much as their common error may be (90 %).
struct ClassLengthRange {
    double length_m = 0;
    double low_m = 0;
    double high_m = 0;
};

/// What is known of the roads of one kind. Every direction that may be driven counts.
struct RoadSummary {
    std::string kind;     ///< of road_kinds(); "" = all
    double network_m = 0; ///< on the map
    double covered_m = 0; ///< with at least one pass
    double thrice_m = 0;  ///< with at least three
    RoadMean mean{};
    double p50 = 0, p85 = 0, p95 = 0;        ///< mm/m, by length; 0 where nothing is covered
    std::vector<ClassLengthRange> classes{}; ///< as in the class table
};

struct NetworkSummary {
    RoadSummary all;
    std::vector<RoadSummary> kinds{}; ///< those on the map, in the order of road_kinds()
};

/// OSM's classes that cars may use, the most important first, and "other" at last.
std::span<const std::string_view> road_kinds();

/// The kind of a highway tag: slip roads count with their road ("primary_link": "primary"), what is
/// not known is "other".
std::string_view road_kind(std::string_view highway);

/// \param measured   segments with a state; others are passed over.
/// \param network_m  by highway tag: metres on the map, measured or not.
NetworkSummary network_summary(std::span<const SegmentRecord> measured,
                               const std::map<std::string, double>& network_m,
                               const ClassTable& classes);

/// Length of road by roughness, m: bins of [0, step), [step, 2 step), ..., the last of which holds
/// all above; in each bin a length for each class of the table.
struct IriHistogram {
    double step_mm_per_m;
    std::vector<std::vector<double>> length_m;
};
IriHistogram iri_histogram(std::span<const SegmentRecord> measured,
                           const ClassTable& classes,
                           double step_mm_per_m,
                           std::size_t bins);

} // namespace macadam
