#include "estimator/iri/localised_roughness.hpp"

#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace macadam {

namespace {

constexpr double rounding = 1e-9; // of a count that is computed

} // namespace

MovingMean::MovingMean(double count)
    : count_{count}, last_(static_cast<std::size_t>(std::ceil(count - rounding)), 0.0) {
    assert(!last_.empty());
}

std::optional<double> MovingMean::push(double value) {
    const std::size_t size = last_.size();
    auto& oldest = last_[pushed_ % size];
    sum_ += value - oldest;
    oldest = value;
    ++pushed_;
    if (pushed_ % size == 0) { // limits the accumulation of rounding errors
        sum_ = std::accumulate(last_.begin(), last_.end(), 0.0);
    }
    if (pushed_ < size) {
        return {};
    }
    const double left_out = static_cast<double>(size) - count_;
    return (sum_ - left_out * last_[pushed_ % size]) / count_;
}

std::optional<RoughInterval> RoughIntervalFinder::push(double at_m, double value) {
    if (!(value > threshold_)) {
        return finish();
    }
    if (!interval_) {
        interval_ = RoughInterval{.from_m = at_m, .to_m = at_m, .peak = value, .peak_at_m = at_m};
    }
    interval_->to_m = at_m;
    if (value > interval_->peak) {
        interval_->peak = value;
        interval_->peak_at_m = at_m;
    }
    return {};
}

std::optional<RoughInterval> RoughIntervalFinder::finish() {
    return std::exchange(interval_, std::nullopt);
}

} // namespace macadam
