#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>

namespace macadam {

/// Estimates the remaining time of a task from its pace in the last two minutes, so that steps that
/// went fast at the beginning (trips that were already imported) do not promise too much.
class RemainingTime {
public:
    using Clock = std::chrono::steady_clock;

    explicit RemainingTime(Clock::time_point begin) : samples_{{begin, 0}} {}

    void add(Clock::time_point now, std::size_t done);

    /// `std::nullopt` during the first five seconds, without progress in the last two minutes, and
    /// if the total is unknown (0).
    std::optional<std::chrono::seconds> left(std::size_t whole) const;

private:
    struct Sample {
        Clock::time_point at;
        std::size_t done;
    };
    std::deque<Sample> samples_; ///< at least a second apart, except for the last
};

} // namespace macadam
