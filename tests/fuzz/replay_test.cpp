// Every fuzz target over its seeds, which its reader accepts, and over what fuzzing found.

#include "target_files.hpp"
#include "target_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ranges>
#include <string>
#include <vector>

namespace macadam::fuzz {
namespace {

class Fuzz : public ::testing::TestWithParam<Target> {
protected:
    /// Refused, too, if it ends otherwise than it may.
    static Answer answer_of(const TargetFile& file) {
        auto answer = Answer::refused;
        EXPECT_NO_THROW(answer = GetParam().run(file.content)) << file.name;
        return answer;
    }
};

TEST_P(Fuzz, SeedsAreAccepted) {
    const auto seeds = seeds_of(GetParam().name);
    ASSERT_FALSE(seeds.empty()) << "no seeds for " << GetParam().name;
    for (const auto& seed : seeds) {
        EXPECT_EQ(answer_of(seed), Answer::accepted) << seed.name;
    }
}

TEST_P(Fuzz, FindingsAreReadOrRefused) {
    for (const auto& finding : findings_of(GetParam().name)) {
        answer_of(finding);
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, ::testing::ValuesIn(targets()), [](const auto& each) {
    return std::string{each.param.name};
});

TEST(FuzzTargets, AreAllInTheTableAndStateTheirReaders) {
    std::vector<std::string> tested;
    for (const auto& target : targets()) {
        tested.emplace_back(target.name);
    }
    std::ranges::sort(tested);
    EXPECT_EQ(tested, declared_targets());
    EXPECT_EQ(tested, targets_with_readers());
    EXPECT_EQ(readers_that_are_not_there(), std::vector<std::string>{});
}

} // namespace
} // namespace macadam::fuzz
