#pragma once

#include "mapping/fusion/segment_record.hpp"
#include "mapping/surveys/survey_score.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// A segment, or about 100 m of them, that cars and a reference know; mm/m.
struct ReferencePair {
    SegmentKey first; ///< of its segments
    SegmentKey last;
    double length_m;
    std::size_t survey;  ///< number of the reference survey
    SurveyPair headline; ///< survey: the reference; trip: the cars, with their interval
    double reference_sd;
    std::optional<SurveyPair> left; ///< where both know it; no interval: low and high are NaN
    std::optional<SurveyPair> right;
    std::int32_t passes; ///< of cars, the least of its segments

    /// How much later the newest pass is than the reference: negative where the reference is newer.
    std::optional<double> days_after;
};

/// A segment as a reference and the cars have it.
struct ReferencedSegment {
    Segment segment;
    Pass reference;
    std::size_t survey;
    std::optional<std::int64_t> reference_utc_ms;
    SegmentState cars; ///< fused from the passes of cars alone
};

/// One pair a segment and reference pass.
///
/// \param segments  in the order of (survey, segment, occurrence).
std::vector<ReferencePair> segment_pairs(std::span<const ReferencedSegment> segments);

/// Pairs of about 100 m: as many consecutive segments as make up 100 m, of one survey, way and
/// direction, that do not overlap; means by length. The interval is that of a mean whose errors
/// hang together along the road (measured_road).
std::vector<ReferencePair> hundred_metre_pairs(std::span<const ReferencedSegment> segments,
                                               double segment_length_m);

/// What is compared of the pairs.
enum class ComparedSide : std::uint8_t { headline, left, right };

/// Those that have it.
std::vector<SurveyPair> pairs_of(std::span<const ReferencePair> pairs, ComparedSide side);

/// The scores of all, and by the reference's IRI in steps of 1 mm/m; those without pairs are left
/// out.
struct ReferenceScores {
    SurveyScore all;
    std::vector<SurveyScore> by_level;
};
ReferenceScores reference_scores(std::span<const SurveyPair> pairs);

} // namespace macadam
