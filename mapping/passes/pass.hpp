#pragma once

#include "estimator/roughness/roughness_trace.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/network/segment.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// What was read of an IRI, in whole micrometres per metre (0.001 mm/m): sums of integers are the
/// same in any order and on any machine.
using IriUm = std::int32_t;

/// One passage of one trip over one segment: the truth that the store keeps.
struct Pass {
    SegmentKey segment;
    std::uint32_t occurrence; ///< 0 for the trip's first passage of the segment, then 1, 2, ...
    std::optional<IriUm> iri_left_um;
    std::optional<IriUm> iri_right_um;
    std::optional<IriUm> iri_centre_um; ///< HRI
    IriUm iri_um;                       ///< the headline: MRI, or what HRI says of it
    IriUm sd_um;                        ///< of the headline, > 0
    bool centre_only;                   ///< MRI was inferred from HRI ("HRI>MRI")
    std::uint8_t validity;              ///< flags of macadam::validity
    std::int32_t speed_mmps;            ///< mean, mm/s
    std::int32_t covered_mm;            ///< of the segment's length
    std::int32_t confidence_ppm;        ///< of the match, 0..1,000,000
    std::int64_t t_ms;                  ///< middle of the passage, since the trip's t0
    std::optional<std::uint32_t>
        drive{}; ///< over the segment's chunk, whose RoughnessTrace it is part of
};

struct PassConfig {
    double min_cover = 0.5;      ///< of the segment's length, with a valid estimate
    double min_confidence = 0.2; ///< of the match, which errs on the low side
                                 ///< (docs/method/matching.md)
};

/// MRI that the mean profile speaks for: real roads have HRI / MRI of 0.86 to 0.96
/// (docs/method/estimation.md). It differs from road to road by 0.035, and within one from piece to
/// piece: by 0.047 over the 100 m pieces of SH 130, Texas, by 0.022 over 20 m of a road with even
/// tracks.
inline constexpr double hri_over_mri = 0.91;
inline constexpr double sd_hri_over_mri = 0.055;

/// What an IRI is known by.
struct Headline {
    double iri_mm_per_m;
    double sd_mm_per_m;
    bool centre_only; ///< inferred from HRI
};
std::optional<Headline> headline_of(const IriMean& mean);

/// Roughness and place meet again on the ruler of travel: the trace's mean over each segment that
/// the trip drove. Ordered as driven.
///
/// Both branches speak of where the centre of gravity is, so nothing is shifted here. What several
/// pieces of one passage say is added up, weighted by the length they cover. A silence of less than
/// the segment's length does not end a passage; coming back later is the next occurrence.
///
/// A passage is left out if less of the segment than `min_cover` has an estimate, or if the match
/// is less certain than `min_confidence`.
std::vector<Pass> extract_passes(const IriTrace& roughness,
                                 const MatchedTrace& matched,
                                 const RoadNetwork& roads,
                                 const Vehicle& vehicle,
                                 const PassConfig& config);

} // namespace macadam
