#pragma once

#include "mapping/passes/pass.hpp"
#include "mapping/surveys/survey_placement.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace macadam {

/// Relative error of an inertial profiler's IRI of an interval of road, 1 sd. Two profilers of
/// Florida's fleet agree within 5.8 in/mi (95 %) on open-graded roads, 3.8 on dense ones, about 3
/// and 2 % of 95 in/mi (A. Nazef, A. Mraz, "High-speed inertial profiler precision on asphalt
/// pavements", Road Profile Users' Group 2013). In addition, the line of the wheels differs between
/// runs: repeated runs on I-76 differ by 4.2 % each on 20 m of one track, 2.1 % on 100 m.
inline constexpr double usual_reference_accuracy = 0.03;

struct ReferenceConfig {
    double relative_sd = usual_reference_accuracy;
    double min_cover = 0.5; ///< of a segment's length
    double min_confidence = PassConfig{}.min_confidence;

    /// Variation of the road's own IRI within a long row: the mean of a part p of a row r differs
    /// from the row's mean by this factor times sqrt(1 - p/r). For 20 m in 100 m 0.25, as in 12 km
    /// of SH 130, Texas (0.27); half of it on a smooth new road.
    double within_row_relative_sd = 0.28;
};

struct ReferencePasses {
    std::vector<Pass> passes;                   ///< in the order of (segment, occurrence)
    double row_m = 0;                           ///< median length of a row
    double placed_m = 0;                        ///< total length of all parts
    std::size_t used = 0;                       ///< rows that entered a pass
    std::map<std::string, std::size_t> reasons; ///< number of unused rows by reason
};

/// Converts a survey to passes over segments: means weighted by the length that each row covers. A
/// segment covered a second time has a second occurrence.
///
/// The sd of a pass is sqrt(a^2 + w^2 s) of its IRI, with a the stated accuracy and w the scatter
/// within rows. With C the covered length of a segment S and o the overlap with a row r,
///     s = sum (o/C)^2 (1 - o/r) + 1 - C/S.
/// An MRI inferred from HRI has the additional uncertainty sd_hri_over_mri.
///
/// Reasons in addition to those of LocatedReference: no_iri, one_track (a left or right IRI alone
/// is no MRI), unsure_match, short_part (less than half of every segment was covered).
ReferencePasses reference_passes(const ReferenceSurvey& survey,
                                 const LocatedReference& placed,
                                 const ReferenceConfig& config);

} // namespace macadam
