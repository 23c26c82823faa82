#include "mapping/surveys/reference_comparison.hpp"

#include "mapping/analysis/correlated_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace macadam {
namespace {

constexpr double no_interval = std::numeric_limits<double>::quiet_NaN();
constexpr double run_m = 100;
constexpr double ms_per_day = 86400e3;
constexpr double level_step_mm_per_m = 1;

double mm_per_m(IriUm um) {
    return um / 1000.0;
}

double length_m(const Segment& segment) {
    return segment.to_m - segment.from_m;
}

/// Computes the length-weighted means of one track; `std::nullopt` if reference or cars lack it
/// anywhere.
std::optional<SurveyPair> side_of(std::span<const ReferencedSegment> run,
                                  std::optional<IriUm> Pass::*of_reference,
                                  std::optional<IriUm> SegmentState::*of_cars) {
    double whole_m = 0, reference = 0, cars = 0;
    for (const auto& one : run) {
        const auto& reference_um = one.reference.*of_reference;
        const auto& cars_um = one.cars.*of_cars;
        if (!reference_um || !cars_um) {
            return std::nullopt;
        }
        whole_m += length_m(one.segment);
        reference += length_m(one.segment) * mm_per_m(*reference_um);
        cars += length_m(one.segment) * mm_per_m(*cars_um);
    }
    return SurveyPair{reference / whole_m, cars / whole_m, no_interval, no_interval};
}

struct ReferenceMean {
    double iri;
    double sd; ///< for a fully common error, as a survey's is
};

ReferenceMean reference_of(std::span<const ReferencedSegment> run) {
    double whole_m = 0, sum = 0, sds = 0;
    for (const auto& one : run) {
        whole_m += length_m(one.segment);
        sum += length_m(one.segment) * mm_per_m(one.reference.iri_um);
        sds += length_m(one.segment) * mm_per_m(one.reference.sd_um);
    }
    return {sum / whole_m, sds / whole_m};
}

RoadMean cars_of(std::span<const ReferencedSegment> run) {
    std::vector<MeasuredPiece> pieces;
    double at_m = 0;
    for (const auto& one : run) {
        const double piece_m = length_m(one.segment);
        pieces.push_back({piece_m, at_m + piece_m / 2, &one.cars});
        at_m += piece_m;
    }
    return measured_road(pieces, {}).mean;
}

std::optional<double> days_after(std::span<const ReferencedSegment> run) {
    std::optional<double> days;
    for (const auto& one : run) {
        if (one.cars.last_seen_ms && one.reference_utc_ms) {
            const double later =
                static_cast<double>(*one.cars.last_seen_ms - *one.reference_utc_ms) / ms_per_day;
            days = std::max(days.value_or(later), later);
        }
    }
    return days;
}

ReferencePair pair_of(std::span<const ReferencedSegment> run) {
    const auto reference = reference_of(run);
    const auto cars = cars_of(run);
    const auto fewest = std::ranges::min_element(
        run, {}, [](const ReferencedSegment& one) { return one.cars.passes; });
    return {.first = run.front().segment.key,
            .last = run.back().segment.key,
            .length_m = cars.length_m,
            .survey = run.front().survey,
            .headline = {reference.iri, cars.iri, cars.low, cars.high},
            .reference_sd = reference.sd,
            .left = side_of(run, &Pass::iri_left_um, &SegmentState::left_um),
            .right = side_of(run, &Pass::iri_right_um, &SegmentState::right_um),
            .passes = fewest->cars.passes,
            .days_after = days_after(run)};
}

/// Builds the pair of a single segment with the stored interval of the cars, not a recomputed one.
ReferencePair pair_of_one(const ReferencedSegment& one) {
    auto pair = pair_of({&one, 1});
    pair.headline.low = mm_per_m(one.cars.low_um);
    pair.headline.high = mm_per_m(one.cars.high_um);
    return pair;
}

bool goes_on(const ReferencedSegment& before, const ReferencedSegment& after) {
    const auto& a = before.segment.key;
    const auto& b = after.segment.key;
    return before.survey == after.survey &&
           before.reference.occurrence == after.reference.occurrence && a.way_id == b.way_id &&
           a.forward == b.forward && a.index + 1 == b.index;
}

} // namespace

std::vector<ReferencePair> segment_pairs(std::span<const ReferencedSegment> segments) {
    std::vector<ReferencePair> pairs;
    pairs.reserve(segments.size());
    for (const auto& one : segments) {
        pairs.push_back(pair_of_one(one));
    }
    return pairs;
}

std::vector<ReferencePair> hundred_metre_pairs(std::span<const ReferencedSegment> segments,
                                               double segment_length_m) {
    std::vector<ReferencedSegment> sorted{segments.begin(), segments.end()};
    std::ranges::stable_sort(sorted, {}, [](const ReferencedSegment& one) {
        return std::tuple{one.survey, one.reference.occurrence, one.segment.key};
    });
    const auto run_segments =
        static_cast<std::size_t>(std::max(1.0, std::round(run_m / segment_length_m)));
    std::vector<ReferencePair> pairs;
    std::size_t first = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (i > first && !goes_on(sorted[i - 1], sorted[i])) {
            first = i;
        }
        if (i - first + 1 == run_segments) {
            pairs.push_back(pair_of(std::span{sorted}.subspan(first, run_segments)));
            first = i + 1;
        }
    }
    return pairs;
}

std::vector<SurveyPair> pairs_of(std::span<const ReferencePair> pairs, ComparedSide side) {
    std::vector<SurveyPair> found;
    for (const auto& pair : pairs) {
        const auto one = side == ComparedSide::headline ? std::optional{pair.headline}
                         : side == ComparedSide::left   ? pair.left
                                                        : pair.right;
        if (one) {
            found.push_back(*one);
        }
    }
    return found;
}

ReferenceScores reference_scores(std::span<const SurveyPair> pairs) {
    double most = 0;
    for (const auto& pair : pairs) {
        most = std::max(most, pair.survey);
    }
    std::vector<double> edges{0};
    while (edges.back() <= most) {
        edges.push_back(edges.back() + level_step_mm_per_m);
    }
    return {score_of(pairs), scores_by_level(pairs, edges)};
}

} // namespace macadam
