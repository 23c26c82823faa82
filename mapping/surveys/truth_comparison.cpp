#include "mapping/surveys/truth_comparison.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>

namespace macadam {
namespace {

constexpr std::size_t run_segments = 5; // 100 m at the usual segment length
constexpr double same_place_m = 0.01;   // truth files have a resolution of millimetres

// Lower limits of bands. Most segments of towns lie below 45 km/h, those of country roads above 65.
constexpr double level_bands[] = {0, 1, 2, 4};    // mm/m
constexpr double speed_bands[] = {0, 45, 65, 85}; // km/h

/// A segment known in both.
struct Pair {
    SegmentKey key;
    std::string highway;
    double length_m;
    double truth;
    double state;
    bool held; ///< truth within the interval
};

double mm_per_m(IriUm um) {
    return um / 1000.0;
}

void check_place(const Segment& segment, const SegmentTruth& truth) {
    if (std::abs(segment.from_m - truth.from_m) > same_place_m ||
        std::abs(segment.to_m - truth.to_m) > same_place_m) {
        throw InputError{fmt::format("segment '{}' is '{:.3f} to {:.3f} m' in the truth, "
                                     "expected {:.3f} to {:.3f} m as in the database: the "
                                     "networks or segment lengths differ",
                                     name_of(segment.key),
                                     truth.from_m,
                                     truth.to_m,
                                     segment.from_m,
                                     segment.to_m)};
    }
}

std::vector<Pair> pairs_of(std::span<const SegmentRecord> states,
                           std::span<const SegmentTruth> truth) {
    std::vector<Pair> pairs;
    auto at = truth.begin();
    for (const auto& record : states) {
        const auto& segment = record.segment;
        at = std::lower_bound(
            at, truth.end(), segment.key, [](const SegmentTruth& t, const SegmentKey& key) {
                return t.key < key;
            });
        if (!record.state || at == truth.end() || at->key != segment.key) {
            continue;
        }
        check_place(segment, *at);
        const auto& state = *record.state;
        pairs.push_back(
            {.key = segment.key,
             .highway = record.highway,
             .length_m = segment.to_m - segment.from_m,
             .truth = at->mri,
             .state = mm_per_m(state.iri_um),
             .held = mm_per_m(state.low_um) <= at->mri && at->mri <= mm_per_m(state.high_um)});
    }
    return pairs;
}

/// Returns the squared errors of runs of consecutive segments.
std::vector<double> squares_of_runs(std::span<const Pair> pairs) {
    std::vector<double> squares;
    std::size_t first = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto& key = pairs[i].key;
        const bool goes_on = i > first && pairs[i - 1].key.way_id == key.way_id &&
                             pairs[i - 1].key.forward == key.forward &&
                             pairs[i - 1].key.index + 1 == key.index;
        first = goes_on ? first : i;
        if (i - first + 1 < run_segments) {
            continue;
        }
        double error = 0;
        double length_m = 0;
        for (auto j = first; j <= i; ++j) {
            error += pairs[j].length_m * (pairs[j].state - pairs[j].truth);
            length_m += pairs[j].length_m;
        }
        squares.push_back((error / length_m) * (error / length_m));
        first = i + 1;
    }
    return squares;
}

double mean(double sum, std::size_t count) {
    return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

double correlation(std::span<const Pair> pairs, double mean_truth, double mean_state) {
    double both = 0;
    double truth = 0;
    double state = 0;
    for (const auto& pair : pairs) {
        both += (pair.truth - mean_truth) * (pair.state - mean_state);
        truth += (pair.truth - mean_truth) * (pair.truth - mean_truth);
        state += (pair.state - mean_state) * (pair.state - mean_state);
    }
    return truth > 0 && state > 0 ? both / std::sqrt(truth * state)
                                  : std::numeric_limits<double>::quiet_NaN();
}

TruthScore score_of(std::span<const Pair> pairs) {
    double truth = 0;
    double state = 0;
    double squares = 0;
    std::size_t held = 0;
    TruthScore score;
    for (const auto& pair : pairs) {
        score.km += pair.length_m / 1000;
        truth += pair.truth;
        state += pair.state;
        squares += (pair.state - pair.truth) * (pair.state - pair.truth);
        held += pair.held ? 1 : 0;
    }
    double run_squares = 0;
    const auto runs = squares_of_runs(pairs);
    for (const double square : runs) {
        run_squares += square;
    }
    score.segments = pairs.size();
    score.runs = runs.size();
    score.mean_truth = mean(truth, pairs.size());
    score.bias = mean(state - truth, pairs.size());
    score.rmse = std::sqrt(mean(squares, pairs.size()));
    score.rmse_100m = std::sqrt(mean(run_squares, runs.size()));
    score.correlation = correlation(pairs, score.mean_truth, mean(state, pairs.size()));
    score.coverage = mean(static_cast<double>(held), pairs.size());
    return score;
}

/// Scores the pairs of each band. \param value_of  NaN: in no band.
std::vector<TruthComparison::Band> bands_of(std::span<const Pair> pairs,
                                            std::span<const double> limits,
                                            const std::function<double(const Pair&)>& value_of) {
    std::vector<TruthComparison::Band> bands;
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const auto to = i + 1 < limits.size() ? std::optional{limits[i + 1]} : std::nullopt;
        std::vector<Pair> within;
        std::ranges::copy_if(pairs, std::back_inserter(within), [&](const Pair& pair) {
            const double value = value_of(pair);
            return value >= limits[i] && !(to && value >= *to);
        });
        if (!within.empty()) {
            bands.push_back({limits[i], to, score_of(within)});
        }
    }
    return bands;
}

} // namespace

TruthComparison compare_with_truth(std::span<const SegmentRecord> states,
                                   std::span<const SegmentTruth> truth,
                                   const std::map<SegmentKey, double>& speed_kmh) {
    const auto pairs = pairs_of(states, truth);
    std::map<std::string, std::vector<Pair>> by_class;
    for (const auto& pair : pairs) {
        by_class[pair.highway].push_back(pair);
    }
    TruthComparison comparison{
        .all = score_of(pairs),
        .classes = {},
        .levels = bands_of(pairs, level_bands, [](const Pair& pair) { return pair.truth; }),
        .speeds = bands_of(pairs, speed_bands, [&](const Pair& pair) {
            const auto found = speed_kmh.find(pair.key);
            return found != speed_kmh.end() ? found->second
                                            : std::numeric_limits<double>::quiet_NaN();
        })};
    for (const auto& [highway, part] : by_class) {
        comparison.classes.push_back({highway, score_of(part)});
    }
    std::ranges::stable_sort(comparison.classes,
                             [](const auto& a, const auto& b) { return a.score.km > b.score.km; });
    return comparison;
}

} // namespace macadam
