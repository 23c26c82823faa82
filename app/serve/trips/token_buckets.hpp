#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Limits how often somebody may do something: `burst` times at once, and then `per_s` times a
/// second. Kept are those who asked within the time of a refill. For one thread.
class TokenBuckets {
public:
    using Clock = std::chrono::steady_clock;

    TokenBuckets(double per_s, double burst) : per_s_{per_s}, burst_{burst} {}

    /// Takes one token from the bucket of a name. \returns the time to wait if it is empty.
    std::optional<std::chrono::seconds> take(std::string_view name,
                                             Clock::time_point now = Clock::now());

    std::size_t count() const { return buckets_.size(); } ///< of those kept

private:
    struct Bucket {
        double tokens;
        Clock::time_point at;
    };

    double filled(const Bucket& bucket, Clock::time_point now) const;

    double per_s_;
    double burst_;
    std::map<std::string, Bucket, std::less<>> buckets_;
    std::size_t drop_at_ = 0; ///< number of buckets at which full ones are dropped next
};

} // namespace macadam
