#pragma once

#include "estimator/roughness/roughness_trace.hpp"
#include "mapping/network/segment.hpp"
#include "mapping/passes/segment_overlap.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// IRI in whole micrometres per metre (0.001 mm/m): integer sums are the same in any order and on
/// any machine.
using IriUm = std::int32_t;

/// One pass of a trip over one segment: the primary data of the database.
struct Pass {
    SegmentKey segment;
    std::uint32_t occurrence; ///< 0 for the trip's first pass over the segment, then 1, 2, ...
    std::optional<IriUm> iri_left_um;
    std::optional<IriUm> iri_right_um;
    std::optional<IriUm> iri_centre_um;   ///< HRI
    IriUm iri_um;                         ///< the headline: MRI, or the MRI estimated from HRI
    IriUm sd_um;                          ///< of the headline, > 0
    bool centre_only;                     ///< MRI was inferred from HRI ("HRI>MRI")
    std::uint8_t validity;                ///< flags of macadam::validity
    std::int32_t speed_mmps;              ///< mean, mm/s
    std::int32_t covered_mm;              ///< of the segment's length
    std::int32_t confidence_ppm;          ///< of the match, 0..1,000,000
    std::int64_t t_ms;                    ///< middle of the pass, since the trip's t0
    std::optional<std::uint32_t> drive{}; ///< number of the RoughnessTrace it belongs to
};

struct PassConfig {
    double min_cover = 0.5;      ///< of the segment's length, with a valid estimate
    double min_confidence = 0.2; ///< of the match, which errs on the low side
                                 ///< (docs/method/matching.md)
};

/// Ratio of HRI to MRI: 0.86 to 0.96 on real roads (docs/method/estimation.md). It varies between
/// roads by 0.035, and within one from interval to interval: by 0.047 over the 100 m intervals of
/// SH 130, Texas, by 0.022 over 20 m of a road with even tracks.
inline constexpr double hri_over_mri = 0.91;
inline constexpr double sd_hri_over_mri = 0.055;

/// Headline IRI with its uncertainty.
struct Headline {
    double iri_mm_per_m;
    double sd_mm_per_m;
    bool centre_only; ///< inferred from HRI
};
std::optional<Headline> headline_of(const IriMean& mean);

/// Pass with the intervals of its segment that the trip drove, in driving order.
struct DrivenPass {
    Pass pass;
    std::vector<SegmentOverlap> parts;
};

/// Joins roughness and matched positions by travel: averages the roughness over each segment that
/// the trip drove. Ordered as driven.
///
/// Both inputs refer to the centre of gravity, so no shift is applied. Several intervals of one
/// pass are combined, weighted by the length they cover. A gap shorter than the segment does not
/// end a pass; a later return is the next occurrence.
///
/// A pass is omitted if less of the segment than `min_cover` has an estimate, or if the match
/// confidence is below `min_confidence`.
std::vector<DrivenPass> driven_passes(std::span<const SegmentOverlap> parts,
                                      const IriTrace& roughness,
                                      const Vehicle& vehicle,
                                      const PassConfig& config);

} // namespace macadam
