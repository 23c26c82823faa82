// Commands under limits of the system (setrlimit): words and exit status 1, never a signal.

#include "resource_limits.hpp"

#include <sys/resource.h>

namespace macadam::testing {
namespace {

// Sanitizers take terabytes of addresses, and descriptors of their own, so those limits are of the
// release build (memory_limit_test).
class CommandUnderALimit : public ::testing::TestWithParam<CommandCase> {};

TEST_P(CommandUnderALimit, OfFileSizeFailsWithWordsAndLeavesNothing) {
    const auto place = new_place();
    for (const std::size_t max_bytes : {1000U, 20'000U}) {
        expect_words_or_success({RLIMIT_FSIZE, max_bytes}, GetParam(), place);
    }
}

INSTANTIATE_TEST_SUITE_P(Commands,
                         CommandUnderALimit,
                         ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace macadam::testing
