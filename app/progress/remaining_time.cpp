#include "app/progress/remaining_time.hpp"

#include <cmath>

namespace macadam {
namespace {

using namespace std::chrono_literals;

constexpr auto window = 120s;
constexpr auto sample_every = 1s;
constexpr auto min_observed = 5s;

} // namespace

void RemainingTime::add(Clock::time_point now, std::size_t done) {
    if (samples_.size() > 1 &&
        samples_.back().at - samples_[samples_.size() - 2].at < sample_every) {
        samples_.pop_back();
    }
    samples_.push_back({now, done});
    while (samples_.size() > 2 && now - samples_[1].at >= window) {
        samples_.pop_front();
    }
}

std::optional<std::chrono::seconds> RemainingTime::left(std::size_t whole) const {
    const auto& [from, done_before] = samples_.front();
    const auto& [to, done] = samples_.back();
    if (to - from < min_observed || done <= done_before || done >= whole) {
        return std::nullopt;
    }
    const double s_per_step =
        std::chrono::duration<double>(to - from).count() / static_cast<double>(done - done_before);
    return std::chrono::seconds{std::llround(s_per_step * static_cast<double>(whole - done))};
}

} // namespace macadam
