#include "mapping/analysis/maximum_scoring_runs.hpp"

namespace macadam {
namespace {

constexpr std::size_t none = ~std::size_t{0};

/// A run that is maximal in the scores read so far. Sums start at the first score.
struct Candidate {
    IndexRange range;
    double sum_before;
    double sum_through;
    std::size_t lower; ///< nearest earlier candidate with a lower sum_before
};

/// Returns the last candidate that begins lower than `sum_before`, skipping those between.
std::size_t
lower_than(const std::vector<Candidate>& candidates, std::size_t from, double sum_before) {
    while (from != none && candidates[from].sum_before >= sum_before) {
        from = candidates[from].lower;
    }
    return from;
}

void add(std::vector<Candidate>& candidates, Candidate fresh) {
    fresh.lower =
        lower_than(candidates, candidates.empty() ? none : candidates.size() - 1, fresh.sum_before);
    while (fresh.lower != none && candidates[fresh.lower].sum_through < fresh.sum_through) {
        const auto joined = candidates[fresh.lower];
        candidates.resize(fresh.lower);
        fresh = {{joined.range.first, fresh.range.last},
                 joined.sum_before,
                 fresh.sum_through,
                 joined.lower};
    }
    candidates.push_back(fresh);
}

} // namespace

std::vector<IndexRange> maximal_scoring_runs(std::span<const double> scores) {
    std::vector<Candidate> candidates;
    double sum = 0;
    for (std::size_t i = 0; i < scores.size(); ++i) {
        if (scores[i] > 0) {
            add(candidates, {{i, i + 1}, sum, sum + scores[i], none});
        }
        sum += scores[i];
    }
    std::vector<IndexRange> runs;
    runs.reserve(candidates.size());
    for (const auto& candidate : candidates) {
        runs.push_back(candidate.range);
    }
    return runs;
}

} // namespace macadam
