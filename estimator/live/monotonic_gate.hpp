#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace macadam {

/// Passes on samples of a stream whose time increases.
///
/// A sample far ahead of the previous one is either a pause of its sensor or a faulty stamp. It
/// waits for the next one: if that follows it, both are passed on; if that follows the sample
/// before, the stamp was faulty. Samples older than the last one passed on are dropped.
template <typename Sample>
class MonotonicGate {
public:
    /// \param pass  called with each sample that is passed on: none, one or two.
    template <typename Pass>
    void add(double t_s, const Sample& sample, Pass pass) {
        if (t_s > last_s_ && t_s - last_s_ <= far_s()) {
            dropped_ += waiting_ ? 1 : 0;
            waiting_.reset();
            let_through(t_s, sample, pass);
        } else if (waiting_ && t_s > waiting_->first) {
            const auto [before_s, before] = *std::exchange(waiting_, std::nullopt);
            let_through(before_s, before, pass);
            let_through(t_s, sample, pass);
        } else if (t_s > last_s_) {
            dropped_ += waiting_ ? 1 : 0;
            waiting_ = {t_s, sample};
        } else {
            ++dropped_;
        }
    }

    std::size_t dropped() const { return dropped_; }

private:
    static constexpr double min_far_s = 1.5;
    static constexpr double far_steps = 3; ///< multiple of the sensor's own step

    double far_s() const { return std::max(min_far_s, far_steps * step_s_); }

    template <typename Pass>
    void let_through(double t_s, const Sample& sample, Pass pass) {
        step_s_ = begun_ ? t_s - last_s_ : 0;
        begun_ = true;
        last_s_ = t_s;
        pass(sample);
    }

    double last_s_ = -std::numeric_limits<double>::infinity();
    double step_s_ = 0;
    bool begun_ = false;
    std::optional<std::pair<double, Sample>> waiting_;
    std::size_t dropped_ = 0;
};

} // namespace macadam
