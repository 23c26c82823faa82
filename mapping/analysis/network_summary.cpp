#include "mapping/analysis/network_summary.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 11> kinds{"motorway",
                                                 "trunk",
                                                 "primary",
                                                 "secondary",
                                                 "tertiary",
                                                 "unclassified",
                                                 "residential",
                                                 "living_street",
                                                 "service",
                                                 "track",
                                                 "other"};
constexpr int shifts = 20; // steps of the common error to either side
constexpr std::int32_t thrice = 3;

/// Returns the length in each class if all readings were biased by `shift` times their common sd.
std::vector<double>
class_lengths_m(std::span<const RatedLength> pieces, const ClassTable& classes, double shift) {
    const double common = std::sqrt(common_share_along_road);
    std::vector<double> lengths_m(classes.classes.size(), 0.0);
    for (const auto& [length_m, iri, sd] : pieces) {
        lengths_m[class_index(classes, iri + shift * common * sd)] += length_m;
    }
    return lengths_m;
}

std::vector<ClassLengthRange> class_ranges(std::span<const RatedLength> pieces,
                                           const ClassTable& classes) {
    std::vector<ClassLengthRange> ranges;
    for (const double length_m : class_lengths_m(pieces, classes, 0)) {
        ranges.push_back({length_m, length_m, length_m});
    }
    for (int i = -shifts; i <= shifts; ++i) {
        const auto shifted = class_lengths_m(pieces, classes, normal_interval_90 * i / shifts);
        for (std::size_t c = 0; c < ranges.size(); ++c) {
            ranges[c].low_m = std::min(ranges[c].low_m, shifted[c]);
            ranges[c].high_m = std::max(ranges[c].high_m, shifted[c]);
        }
    }
    return ranges;
}

/// \param kind  "" for all.
RoadSummary summary_of(std::span<const MeasuredSegment> measured,
                       std::string_view kind,
                       const ClassTable& classes) {
    RoadSummary summary{.kind = std::string{kind}};
    std::vector<RatedLength> pieces;
    for (const auto& segment : measured) {
        if (kind.empty() || road_kind(segment.highway) == kind) {
            pieces.push_back(rated_length(segment));
            summary.thrice_m += segment.passes >= thrice ? pieces.back().length_m : 0;
        }
    }
    summary.mean = road_mean(pieces);
    summary.covered_m = summary.mean.length_m;
    summary.classes = class_ranges(pieces, classes);
    if (!pieces.empty()) {
        summary.p50 = road_percentile(pieces, 0.50);
        summary.p85 = road_percentile(pieces, 0.85);
        summary.p95 = road_percentile(pieces, 0.95);
    }
    return summary;
}

} // namespace

std::span<const std::string_view> road_kinds() {
    return kinds;
}

std::string_view road_kind(std::string_view highway) {
    constexpr std::string_view link = "_link";
    if (highway.ends_with(link)) {
        highway.remove_suffix(link.size());
    }
    const auto* const found = std::ranges::find(kinds, highway);
    return found != kinds.end() ? *found : kinds.back();
}

NetworkSummary network_summary(std::span<const MeasuredSegment> measured,
                               const std::map<std::string, double>& network_m,
                               const ClassTable& classes) {
    std::map<std::string_view, double> of_kind_m;
    NetworkSummary summary{.all = summary_of(measured, "", classes)};
    for (const auto& [highway, length_m] : network_m) {
        of_kind_m[road_kind(highway)] += length_m;
        summary.all.network_m += length_m;
    }
    for (const auto kind : kinds) {
        if (const auto found = of_kind_m.find(kind); found != of_kind_m.end()) {
            summary.kinds.push_back(summary_of(measured, kind, classes));
            summary.kinds.back().network_m = found->second;
        }
    }
    return summary;
}

IriHistogram iri_histogram(std::span<const MeasuredSegment> measured,
                           const ClassTable& classes,
                           double step_mm_per_m,
                           std::size_t bins) {
    IriHistogram histogram{step_mm_per_m, {}};
    histogram.length_m.assign(bins, std::vector<double>(classes.classes.size(), 0.0));
    for (const auto& segment : measured) {
        const auto piece = rated_length(segment);
        const auto bin = static_cast<std::size_t>(piece.iri / step_mm_per_m);
        histogram.length_m[std::min(bin, bins - 1)][class_index(classes, piece.iri)] +=
            piece.length_m;
    }
    return histogram;
}

} // namespace macadam
