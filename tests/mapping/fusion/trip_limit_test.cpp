#include "mapping/fusion/trip_limit.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <random>
#include <set>
#include <tuple>
#include <vector>

namespace macadam {
namespace {

constexpr std::int64_t day_ms = 86'400'000;
constexpr std::int64_t new_year_2026_ms = 1'767'225'600'000; // date -d 2026-01-01Z +%s

FusionInput pass(const std::string& trip,
                 std::int64_t vehicle,
                 std::optional<std::int64_t> utc_ms,
                 unsigned occurrence = 0) {
    FusionInput input{};
    input.pass.occurrence = occurrence;
    input.trip_sha256 = trip;
    input.vehicle = vehicle;
    input.utc_ms = utc_ms;
    return input;
}

std::vector<std::string> admitted(std::vector<FusionInput> passes, std::int64_t max_trips) {
    std::ranges::sort(passes, {}, [](const FusionInput& input) {
        return std::tuple{input.trip_sha256, input.pass.occurrence};
    });
    TripLimit limit{max_trips};
    limit.begin_segment();
    std::vector<std::string> trips;
    for (const auto& input : passes) {
        if (limit.admits(input)) {
            trips.push_back(input.trip_sha256);
        }
    }
    return trips;
}

using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(TripLimits, AdmitTheLowestHashesOfACarInAMonth) {
    const std::vector<FusionInput> passes{pass("c", 1, new_year_2026_ms),
                                          pass("a", 1, new_year_2026_ms + 30 * day_ms),
                                          pass("b", 1, new_year_2026_ms + 3 * day_ms)};
    EXPECT_THAT(admitted(passes, 2), ElementsAre("a", "b"));
    EXPECT_THAT(admitted(passes, 3), ElementsAre("a", "b", "c"));
}

TEST(TripLimits, CountEachCarAndEachMonthInUtcByItself) {
    EXPECT_THAT(admitted({pass("a", 1, new_year_2026_ms - 1),
                          pass("b", 1, new_year_2026_ms),
                          pass("c", 1, new_year_2026_ms + 31 * day_ms - 1),
                          pass("d", 2, new_year_2026_ms),
                          pass("e", 1, std::nullopt),
                          pass("f", 1, std::nullopt)},
                         1),
                ElementsAre("a", "b", "d", "e"));
}

TEST(TripLimits, AdmitAllPassesOfATripOverTheSegment) {
    EXPECT_THAT(admitted({pass("a", 1, new_year_2026_ms, 0),
                          pass("a", 1, new_year_2026_ms, 1),
                          pass("b", 1, new_year_2026_ms)},
                         1),
                ElementsAre("a", "a"));
}

TEST(TripLimits, DoNotLimitSurveysOrWithoutANumber) {
    auto survey = pass("b", -7, new_year_2026_ms), another = pass("c", -7, new_year_2026_ms);
    survey.reference = another.reference = true;
    EXPECT_THAT(admitted({survey, another}, 1), SizeIs(2));
    EXPECT_THAT(admitted({pass("a", 1, {}), pass("b", 1, {})}, 0), SizeIs(2));
}

TEST(TripLimits, DoNotLimitUnknownCars) {
    constexpr std::int64_t unknown_car = 3;
    TripLimit limit{1, unknown_car};
    for (const auto* const trip : {"a", "b", "c"}) {
        EXPECT_TRUE(limit.admits(pass(trip, unknown_car, new_year_2026_ms)));
    }
    EXPECT_TRUE(limit.admits(pass("d", 1, new_year_2026_ms)));
    EXPECT_FALSE(limit.admits(pass("e", 1, new_year_2026_ms)));
}

TEST(TripLimits, StartAnewWithEachSegment) {
    TripLimit limit{1};
    EXPECT_TRUE(limit.admits(pass("b", 1, {})));
    EXPECT_FALSE(limit.admits(pass("c", 1, {})));
    limit.begin_segment();
    EXPECT_TRUE(limit.admits(pass("c", 1, {})));
}

// By another road: for each pass, how many trips of its car and month have lower hashes.
TEST(TripLimits, AgreeWithCountingLowerHashesOfRandomPasses) {
    std::mt19937 random{5};
    for (int world = 0; world < 50; ++world) {
        std::vector<FusionInput> passes;
        for (unsigned trip = 0; trip < 60; ++trip) {
            const auto vehicle = static_cast<std::int64_t>(random() % 4);
            const auto month = static_cast<std::int64_t>(random() % 4); // 0: undated
            for (unsigned occurrence = 0; occurrence <= random() % 2; ++occurrence) {
                passes.push_back(
                    pass(fmt::format("{:08x}", random() / 64 * 64 + trip),
                         vehicle,
                         month == 0 ? std::nullopt
                                    : std::optional{new_year_2026_ms + (31 * month + 5) * day_ms},
                         occurrence));
            }
        }
        const auto max_trips = static_cast<std::int64_t>(1 + random() % 5);
        std::vector<std::string> expected;
        for (const auto& input : passes) {
            std::set<std::string> lower;
            for (const auto& other : passes) {
                if (other.vehicle == input.vehicle && other.utc_ms == input.utc_ms &&
                    other.trip_sha256 < input.trip_sha256) {
                    lower.insert(other.trip_sha256);
                }
            }
            if (std::ssize(lower) < max_trips) {
                expected.push_back(input.trip_sha256);
            }
        }
        std::ranges::sort(expected);
        std::ranges::shuffle(passes, random);
        ASSERT_LT(expected.size(), passes.size());
        EXPECT_EQ(admitted(passes, max_trips), expected);
    }
}

} // namespace
} // namespace macadam
