// Commands in a small address space, or with few open files: words and exit status 1, never a
// signal.

#include "app/hostile/resource_limits.hpp"

#include <sys/resource.h>

namespace macadam::testing {
namespace {

constexpr std::size_t megabyte = 1'000'000;

class CommandInASmallAddressSpace : public ::testing::TestWithParam<CommandCase> {};

TEST_P(CommandInASmallAddressSpace, EndsWithWordsOrIsDone) {
    const auto place = new_place();
    for (const std::size_t max_mb : {500U, 400U, 300U}) {
        expect_words_or_success({RLIMIT_AS, max_mb * megabyte}, GetParam(), place);
    }
}

class CommandWithFewFiles : public ::testing::TestWithParam<CommandCase> {};

TEST_P(CommandWithFewFiles, FailsWithWordsAndLeavesNothing) {
    const auto place = new_place();
    for (const std::size_t max_files : {6U, 8U}) {
        expect_words_or_success({RLIMIT_NOFILE, max_files}, GetParam(), place);
    }
}

INSTANTIATE_TEST_SUITE_P(Commands,
                         CommandWithFewFiles,
                         ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(Commands,
                         CommandInASmallAddressSpace,
                         ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace macadam::testing
