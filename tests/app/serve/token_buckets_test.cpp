#include "app/serve/trips/token_buckets.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>

namespace macadam::testing {
namespace {

using namespace std::chrono_literals;

TEST(TokenBuckets, LetNobodyGoOnBecauseManyOthersAsk) {
    TokenBuckets buckets{1, 3};
    const auto now = TokenBuckets::Clock::now();
    for (int i = 0; i < 3; ++i) {
        EXPECT_FALSE(buckets.take("greedy", now));
    }
    EXPECT_EQ(buckets.take("greedy", now), 1s);
    for (int i = 0; i < 30'000; ++i) {
        EXPECT_FALSE(buckets.take(fmt::format("other {}", i), now));
    }
    EXPECT_EQ(buckets.take("greedy", now), 1s);
}

TEST(TokenBuckets, KeepNoneOfThoseWhoHaveNotAskedForLong) {
    TokenBuckets buckets{1, 3};
    const auto begin = TokenBuckets::Clock::now();
    for (int i = 0; i < 100'000; ++i) { // a thousand a second
        buckets.take(fmt::format("{}", i), begin + i * 1ms);
    }
    EXPECT_LE(buckets.count(), 10'000U);
}

} // namespace
} // namespace macadam::testing
