#include "mapping/passes/pass.hpp"

#include "estimator/roughness/roughness_mean.hpp"
#include "mapping/passes/track_difference.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace macadam {
namespace {

constexpr double millionths = 1e6;
constexpr double thousandths = 1e3;
constexpr double largest_um = 1e9; // far above any road

/// One pass over one segment, as matched.
struct Traversal {
    SegmentKey segment;
    double segment_m;                   ///< length of the segment
    std::vector<TravelSpan> travel;     ///< disjoint
    double offset_m = 0;                ///< driven along the road
    double confident_m = 0;             ///< driven length times the confidence of the match
    std::optional<std::uint32_t> drive; ///< number over the chunk
    double t_enter_s;
    double t_leave_s;
    std::vector<SegmentOverlap> parts;
};

bool goes_on(const Traversal& traversal, const SegmentOverlap& part) {
    return traversal.segment == part.segment &&
           part.travel.from_m - traversal.travel.back().to_m < traversal.segment_m;
}

Traversal longer_by(Traversal traversal, const SegmentOverlap& part) {
    if (!traversal.travel.empty() && traversal.travel.back().to_m == part.travel.from_m) {
        traversal.travel.back().to_m = part.travel.to_m;
    } else {
        traversal.travel.push_back(part.travel);
    }
    const double length_m = part.to_station_m - part.from_station_m;
    traversal.offset_m += length_m;
    traversal.confident_m += length_m * part.confidence;
    traversal.t_leave_s = part.t_leave_s;
    traversal.parts.push_back(part);
    return traversal;
}

std::vector<Traversal> traversals_of(std::span<const SegmentOverlap> parts) {
    std::vector<Traversal> traversals;
    for (const auto& part : parts) {
        if (traversals.empty() || !goes_on(traversals.back(), part)) {
            traversals.push_back({.segment = part.segment,
                                  .segment_m = part.segment_m,
                                  .travel = {},
                                  .drive = part.drive,
                                  .t_enter_s = part.t_enter_s,
                                  .t_leave_s = part.t_leave_s,
                                  .parts = {}});
        }
        traversals.back() = longer_by(std::move(traversals.back()), part);
    }
    return traversals;
}

using Known = std::optional<double>;

/// Roughness of a segment in one pass; sums over its travel ranges, weighted by covered length. A
/// side is only valid if every range has it.
struct Reading {
    double covered_m = 0; ///< along the trip
    double iri = 0;
    double sd = 0;
    Known left = 0;
    Known right = 0;
    Known centre = 0;
    double speed = 0;
    bool centre_only = false;
    std::uint8_t validity = validity::ok;
};

Known sum_of(const Known& sum, const Known& value, double weight) {
    return sum && value ? Known{*sum + weight * *value} : std::nullopt;
}

Reading read(const Traversal& traversal,
             const IriTrace& roughness,
             const std::optional<TrackDifference>& tracks,
             const Vehicle& vehicle) {
    Reading reading;
    for (const auto& range : traversal.travel) {
        const auto mean = mean_over(roughness, range.from_m, range.to_m, vehicle);
        const auto headline = headline_of(mean, ratio_over(tracks, range.from_m, range.to_m));
        const double w = mean.covered_m;
        if (!headline || !(w > 0)) {
            continue;
        }
        reading.covered_m += w;
        reading.iri += w * headline->iri_mm_per_m;
        reading.sd += w * headline->sd_mm_per_m; // same car: errors of its ranges are common
        reading.speed += w * mean.speed_mps;
        reading.left = sum_of(reading.left, mean.left_mm_per_m, w);
        reading.right = sum_of(reading.right, mean.right_mm_per_m, w);
        reading.centre = sum_of(reading.centre, mean.hri_mm_per_m, w);
        reading.centre_only = reading.centre_only || headline->centre_only;
        reading.validity |= mean.validity;
    }
    return reading;
}

IriUm whole_um(double mm_per_m) {
    return static_cast<IriUm>(std::lround(mm_per_m * thousandths));
}

std::optional<IriUm> whole_um(const Known& sum, double weights) {
    return sum ? std::optional{whole_um(*sum / weights)} : std::nullopt;
}

double driven_m(const Traversal& traversal) {
    double sum_m = 0;
    for (const auto& range : traversal.travel) {
        sum_m += range.to_m - range.from_m;
    }
    return sum_m;
}

/// An MRI inferred from HRI is also indicative; the flag then no longer states the reason.
std::uint8_t validity_of(const Reading& reading) {
    unsigned flags = reading.validity;
    flags |= (flags & validity::indicative) != 0 ? validity::lateral_alone : 0U;
    flags |= reading.centre_only ? validity::indicative : 0U;
    return static_cast<std::uint8_t>(flags);
}

Pass quantised(const Traversal& traversal, const Reading& r, double covered_m) {
    const double confidence = traversal.confident_m / traversal.offset_m;
    return {
        .segment = traversal.segment,
        .occurrence = 0,
        .iri_left_um = whole_um(r.left, r.covered_m),
        .iri_right_um = whole_um(r.right, r.covered_m),
        .iri_centre_um = whole_um(r.centre, r.covered_m),
        .iri_um = whole_um(r.iri / r.covered_m),
        .sd_um = std::max(1, whole_um(r.sd / r.covered_m)),
        .centre_only = r.centre_only,
        .validity = validity_of(r),
        .speed_mmps = static_cast<std::int32_t>(std::lround(r.speed / r.covered_m * thousandths)),
        .covered_mm = static_cast<std::int32_t>(std::lround(covered_m * thousandths)),
        .confidence_ppm =
            static_cast<std::int32_t>(std::lround(std::clamp(confidence, 0.0, 1.0) * millionths)),
        .t_ms = std::llround((traversal.t_enter_s + traversal.t_leave_s) / 2 * thousandths),
        .drive = traversal.drive};
}

std::optional<Pass> pass_of(const Traversal& traversal,
                            const IriTrace& roughness,
                            const std::optional<TrackDifference>& tracks,
                            const Vehicle& vehicle,
                            const PassConfig& config) {
    if (traversal.confident_m < config.min_confidence * traversal.offset_m) {
        return std::nullopt;
    }
    const auto reading = read(traversal, roughness, tracks, vehicle);
    // Metres of travel represent metres of road; a match that stepped back covers none twice.
    const double covered_m =
        std::min(traversal.segment_m, reading.covered_m * traversal.offset_m / driven_m(traversal));
    const bool is_read = reading.iri / reading.covered_m * thousandths < largest_um &&
                         reading.sd / reading.covered_m * thousandths < largest_um;
    if (!is_read || covered_m < config.min_cover * traversal.segment_m) {
        return std::nullopt;
    }
    return quantised(traversal, reading, covered_m);
}

} // namespace

std::optional<Headline> headline_of(const IriMean& mean) {
    return headline_of(mean, {hri_over_mri, sd_hri_over_mri});
}

std::vector<DrivenPass> driven_passes(std::span<const SegmentOverlap> parts,
                                      const IriTrace& roughness,
                                      const Vehicle& vehicle,
                                      const PassConfig& config) {
    const auto tracks = track_difference_of(roughness, vehicle);
    std::vector<DrivenPass> passes;
    std::map<SegmentKey, std::uint32_t> occurrences;
    for (auto& traversal : traversals_of(parts)) {
        if (auto pass = pass_of(traversal, roughness, tracks, vehicle, config)) {
            pass->occurrence = occurrences[pass->segment]++;
            passes.push_back({*pass, std::move(traversal.parts)});
        }
    }
    return passes;
}

} // namespace macadam
