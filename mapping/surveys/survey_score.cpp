#include "mapping/surveys/survey_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace macadam {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double no_end = std::numeric_limits<double>::infinity();
constexpr std::array band_edges{0.0, 2.0, 4.0, 6.0, 12.0, no_end};

/// Sums of squares about the means.
struct Spread {
    double survey = 0;
    double trip = 0;
    double both = 0;
};

Spread spread_of(std::span<const SurveyPair> pairs, const SurveyScore& score) {
    Spread spread;
    for (const auto& pair : pairs) {
        const double survey = pair.survey - score.mean_survey;
        const double trip = pair.trip - score.mean_trip;
        spread.survey += survey * survey;
        spread.trip += trip * trip;
        spread.both += survey * trip;
    }
    return spread;
}

} // namespace

SurveyScore score_of(std::span<const SurveyPair> pairs) {
    SurveyScore score{.pieces = pairs.size()};
    double squares = 0;
    double held = 0, intervals = 0;
    for (const auto& pair : pairs) {
        score.mean_survey += pair.survey;
        score.mean_trip += pair.trip;
        squares += (pair.trip - pair.survey) * (pair.trip - pair.survey);
        held += pair.low <= pair.survey && pair.survey <= pair.high ? 1 : 0;
        intervals += std::isnan(pair.low) ? 0 : 1;
    }
    const auto count = static_cast<double>(pairs.size());
    score.mean_survey = count > 0 ? score.mean_survey / count : none;
    score.mean_trip = count > 0 ? score.mean_trip / count : none;
    score.bias = score.mean_trip - score.mean_survey;
    score.rmse = count > 0 ? std::sqrt(squares / count) : none;
    score.coverage = intervals > 0 ? held / intervals : none;
    const auto spread = spread_of(pairs, score);
    const double of_error = spread.survey + spread.trip - 2 * spread.both;
    score.sd = count > 1 ? std::sqrt(std::max(0.0, of_error) / (count - 1)) : none;
    score.correlation = spread.survey > 0 && spread.trip > 0
                            ? spread.both / std::sqrt(spread.survey * spread.trip)
                            : none;
    return score;
}

std::vector<SurveyScore> scores_by_level(std::span<const SurveyPair> pairs,
                                         std::span<const double> edges) {
    std::vector<SurveyScore> scores;
    for (std::size_t level = 0; level + 1 < edges.size(); ++level) {
        std::vector<SurveyPair> part;
        std::ranges::copy_if(pairs, std::back_inserter(part), [&](const SurveyPair& pair) {
            return edges[level] <= pair.survey && pair.survey < edges[level + 1];
        });
        if (!part.empty()) {
            scores.push_back(score_of(part));
            scores.back().from_mm_per_m = edges[level];
            scores.back().to_mm_per_m = edges[level + 1];
        }
    }
    return scores;
}

std::vector<SurveyScore> scores_by_band(std::span<const SurveyPair> pairs) {
    return scores_by_level(pairs, band_edges);
}

} // namespace macadam
