#pragma once

#include "mapping/fusion/segment_record.hpp"
#include "mapping/surveys/survey_score.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// A segment, or about 100 m of segments, measured by cars and a reference; mm/m.
struct ReferencePair {
    SegmentKey first; ///< first of its segments
    SegmentKey last;
    double length_m;
    std::size_t survey;  ///< number of the reference survey
    SurveyPair headline; ///< survey: the reference; trip: the cars, with their interval
    double reference_sd;
    std::optional<SurveyPair> left; ///< if both measured it; no interval: low and high are NaN
    std::optional<SurveyPair> right;
    std::int32_t passes; ///< of cars, minimum over its segments

    /// Days from the reference to the newest pass: negative if the reference is newer.
    std::optional<double> days_after;
};

/// A segment as measured by a reference and by the cars.
struct ReferencedSegment {
    Segment segment;
    Pass reference;
    std::size_t survey;
    std::optional<std::int64_t> reference_utc_ms;
    SegmentState cars; ///< fused from car passes alone
};

/// Builds one pair per segment and reference pass.
///
/// \param segments  in the order of (survey, segment, occurrence).
std::vector<ReferencePair> segment_pairs(std::span<const ReferencedSegment> segments);

/// Builds disjoint pairs of about 100 m: as many consecutive segments as make up 100 m, of one
/// survey, way and direction, with length-weighted means. The interval is that of a mean with
/// errors correlated along the road (measured_road).
std::vector<ReferencePair> hundred_metre_pairs(std::span<const ReferencedSegment> segments,
                                               double segment_length_m);

/// Quantity compared in the pairs.
enum class ComparedSide : std::uint8_t { headline, left, right };

/// Extracts the values of the pairs that have this side.
std::vector<SurveyPair> pairs_of(std::span<const ReferencePair> pairs, ComparedSide side);

/// Scores of all pairs, and by the reference's IRI in steps of 1 mm/m; levels without pairs are
/// omitted.
struct ReferenceScores {
    SurveyScore all;
    std::vector<SurveyScore> by_level;
};
ReferenceScores reference_scores(std::span<const SurveyPair> pairs);

} // namespace macadam
