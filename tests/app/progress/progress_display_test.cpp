#include "app/progress/progress_display.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

using namespace std::chrono_literals;

const ProgressUnit trips{.name = "trip", .parts = 1000};

TEST(ProgressText, CountsWholeUnits) {
    EXPECT_EQ(progress_text(trips, 12'900, 120'000, 240s), "12/120 trips, 4 min left");
    EXPECT_EQ(progress_text(trips, 12'900, 120'000, std::nullopt), "12/120 trips");
}

TEST(ProgressText, LeavesOutATotalThatIsUnknown) {
    EXPECT_EQ(progress_text(trips, 12'900, 0, std::nullopt), "12 trips");
    EXPECT_EQ(progress_text({}, 7, 0, std::nullopt), "...");
}

TEST(ProgressText, StatesTimesInSuitableUnits) {
    EXPECT_EQ(progress_text({}, 45, 100, 119s), " 45 %, 119 s left");
    EXPECT_EQ(progress_text({}, 45, 100, 150s), " 45 %, 2 min left");
    EXPECT_EQ(progress_text({}, 45, 100, 10'000s), " 45 %, 3 h left");
}

TEST(ProgressDisplay, WritesNoLineInTheFirstHalfMinuteAwayFromATerminal) {
    ::testing::internal::CaptureStderr();
    const auto progress = progress_display("importing", trips, false);
    progress(1000, 3000);
    progress(3000, 3000);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ProgressDisplay, DrawsABarThatDisappearsWhenItIsFull) {
    ::testing::internal::CaptureStderr();
    const auto progress = progress_display("importing", trips, true);
    progress(1000, 3000);
    progress(1001, 3000); // the same words are not written again
    progress(3000, 3000);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "\rimporting [==========                    ] 1/3 trips\033[K\r\033[K");
}

} // namespace
} // namespace macadam
