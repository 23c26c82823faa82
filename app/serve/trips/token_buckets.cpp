#include "app/serve/trips/token_buckets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace macadam {
namespace {

constexpr std::size_t min_kept = 10'000; // buckets; full ones beyond that are dropped

} // namespace

double TokenBuckets::filled(const Bucket& bucket, Clock::time_point now) const {
    const std::chrono::duration<double> gone = now - bucket.at;
    return std::min(burst_, bucket.tokens + gone.count() * per_s_);
}

std::optional<std::chrono::seconds> TokenBuckets::take(std::string_view name,
                                                       Clock::time_point now) {
    if (buckets_.size() >= std::max(min_kept, drop_at_)) {
        std::erase_if(buckets_, // those of others would be full again, too
                      [&](const auto& entry) { return filled(entry.second, now) >= burst_; });
        drop_at_ = 2 * buckets_.size();
    }
    auto bucket = buckets_.find(name);
    if (bucket == buckets_.end()) {
        bucket = buckets_.emplace(name, Bucket{.tokens = burst_, .at = now}).first;
    }
    bucket->second = {.tokens = filled(bucket->second, now), .at = now};
    if (bucket->second.tokens < 1) {
        const double wait_s = std::ceil((1 - bucket->second.tokens) / per_s_);
        return std::chrono::seconds{std::max<std::int64_t>(1, static_cast<std::int64_t>(wait_s))};
    }
    bucket->second.tokens -= 1;
    return std::nullopt;
}

} // namespace macadam
