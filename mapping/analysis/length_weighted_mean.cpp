#include "mapping/analysis/length_weighted_mean.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace macadam {
namespace {

constexpr double um_per_mm = 1000;

} // namespace

RatedLength rated_length(const SegmentRecord& record) {
    assert(record.state);
    return {record.segment.to_m - record.segment.from_m,
            record.state->iri_um / um_per_mm,
            record.state->sd_um / um_per_mm};
}

RatedLength rated_length(const MeasuredSegment& segment) {
    return {segment.to_m - segment.from_m, segment.iri_um / um_per_mm, segment.sd_um / um_per_mm};
}

RoadMean road_mean(std::span<const RatedLength> pieces, double common_share) {
    RoadMean mean;
    double sum = 0, together = 0, apart = 0;
    for (const auto& [length_m, iri, sd] : pieces) {
        mean.length_m += length_m;
        sum += length_m * iri;
        together += length_m * sd;
        apart += length_m * sd * length_m * sd;
    }
    if (mean.length_m <= 0) {
        return {};
    }
    mean.iri = sum / mean.length_m;
    mean.sd = std::sqrt(std::lerp(apart, together * together, common_share)) / mean.length_m;
    mean.low = std::max(0.0, mean.iri - normal_interval_90 * mean.sd);
    mean.high = mean.iri + normal_interval_90 * mean.sd;
    return mean;
}

double road_percentile(std::vector<RatedLength> pieces, double share) {
    assert(!pieces.empty());
    std::ranges::sort(pieces, {}, &RatedLength::iri);
    double whole_m = 0;
    for (const auto& piece : pieces) {
        whole_m += piece.length_m;
    }
    double passed_m = 0;
    for (const auto& piece : pieces) {
        passed_m += piece.length_m;
        if (passed_m >= share * whole_m * (1 - 1e-12)) { // sums of lengths are not exact
            return piece.iri;
        }
    }
    return pieces.back().iri;
}

} // namespace macadam
