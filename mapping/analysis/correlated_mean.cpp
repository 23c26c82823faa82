#include "mapping/analysis/correlated_mean.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <vector>

namespace macadam {
namespace {

constexpr double um_per_mm = 1000;

/// Accumulates the sum over all pairs of a_i a_j exp(-|x_i - x_j| / L). All earlier terms decay by
/// the same factor, so one running sum suffices.
class FadingPairs {
public:
    explicit FadingPairs(double correlation_m) : correlation_m_{correlation_m} {}

    void add(double at_m, double amount) {
        const double faded = correlation_m_ > 0 ? std::exp(-(at_m - last_m_) / correlation_m_) : 0;
        behind_ *= faded;
        sum_ += amount * (amount + 2 * behind_);
        behind_ += amount;
        last_m_ = at_m;
    }
    double sum() const { return sum_; }

private:
    double correlation_m_;
    double behind_ = 0; ///< sum of a_i exp(-(x - x_i) / L)
    double sum_ = 0;
    double last_m_ = 0;
};

RoadMean mean_of(std::span<const MeasuredPiece> pieces, const ErrorAlongRoad& errors) {
    RoadMean mean;
    double sum = 0, together = 0;
    FadingPairs pairs{errors.correlation_m};
    for (const auto& [length_m, at_m, state] : pieces) {
        const double error = length_m * state->sd_um / um_per_mm;
        mean.length_m += length_m;
        sum += length_m * state->iri_um / um_per_mm;
        together += error;
        pairs.add(at_m, error);
    }
    if (mean.length_m <= 0) {
        return {};
    }
    mean.iri = sum / mean.length_m;
    mean.sd =
        std::sqrt(std::lerp(pairs.sum(), together * together, errors.common_share)) / mean.length_m;
    mean.low = std::max(0.0, mean.iri - normal_interval_90 * mean.sd);
    mean.high = mean.iri + normal_interval_90 * mean.sd;
    return mean;
}

/// Returns the earlier or later of two times, by `better`; the known one if only one is known.
template <typename Better>
std::optional<std::int64_t>
better_of(std::optional<std::int64_t> a, std::optional<std::int64_t> b, Better better) {
    return a && b ? std::optional{better(*a, *b) ? *a : *b} : a ? a : b;
}

} // namespace

CorrelatedMean measured_road(std::span<const MeasuredPiece> pieces, const ErrorAlongRoad& errors) {
    assert(std::ranges::is_sorted(pieces, {}, &MeasuredPiece::at_m));
    CorrelatedMean road;
    road.mean = mean_of(pieces, errors);
    std::vector<std::int32_t> passes;
    passes.reserve(pieces.size());
    for (const auto& piece : pieces) {
        const auto& state = *piece.state;
        passes.push_back(state.passes);
        road.worst_iri = std::max(road.worst_iri, state.iri_um / um_per_mm);
        road.vehicles = std::max(road.vehicles, state.vehicles);
        road.first_seen_ms = better_of(road.first_seen_ms, state.first_seen_ms, std::less<>{});
        road.last_seen_ms = better_of(road.last_seen_ms, state.last_seen_ms, std::greater<>{});
    }
    if (!passes.empty()) {
        std::ranges::sort(passes);
        road.min_passes = passes.front();
        road.median_passes = (passes[(passes.size() - 1) / 2] + passes[passes.size() / 2]) / 2.0;
    }
    return road;
}

} // namespace macadam
