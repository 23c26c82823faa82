#pragma once

#include "mapping/passes/pass.hpp"
#include "mapping/surveys/survey_placement.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace macadam {

/// What an inertial profiler's IRI of a piece of road is off by, 1 sd. Two profilers of Florida's
/// fleet agree within 5.8 in/mi (95 %) on open-graded roads, 3.8 on dense ones, about 3 and 2 % of
/// 95 in/mi (A. Nazef, A. Mraz, "High-speed inertial profiler precision on asphalt pavements",
/// Road Profile Users' Group 2013). Beside it stands what no two runs share, in which line the
/// wheels went: repeated runs on I-76 differ by 4.2 % each on 20 m of one track, 2.1 % on 100 m.
inline constexpr double usual_reference_accuracy = 0.03;

struct ReferenceConfig {
    double relative_sd = usual_reference_accuracy;
    double min_cover = 0.5; ///< of a segment's length
    double min_confidence = PassConfig{}.min_confidence;

    /// Of the road's own IRI within a long row: a piece p of a row r differs from the row's mean by
    /// so much times sqrt(1 - p/r). Of 20 m in 100 m 0.25, as in 12 km of SH 130, Texas (0.27); a
    /// smooth new road has half of it.
    double within_row_relative_sd = 0.28;
};

struct ReferencePasses {
    std::vector<Pass> passes;                   ///< in the order of (segment, occurrence)
    double row_m = 0;                           ///< the median row's length
    double placed_m = 0;                        ///< of all parts
    std::size_t used = 0;                       ///< rows that entered a pass
    std::map<std::string, std::size_t> reasons; ///< why the others did not
};

/// A survey as passes over segments: means weighted by the length that each row covers. A segment
/// that is covered a second time is a second occurrence.
///
/// The sd of a pass is sqrt(a^2 + w^2 s) of its IRI, a the stated accuracy and w the scatter within
/// rows: with C the covered length of a segment S and o the part of a row r in it,
/// s = sum (o/C)^2 (1 - o/r) + 1 - C/S. An MRI inferred from HRI is less sure by
/// sd_hri_over_mri.
///
/// Reasons beside those of PlacedReference: no_iri, one_track (a left or right IRI alone is no
/// MRI), unsure_match, short_part (of no segment half was covered).
ReferencePasses reference_passes(const ReferenceSurvey& survey,
                                 const PlacedReference& placed,
                                 const ReferenceConfig& config);

} // namespace macadam
