#include "app/terminal/text_style.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include <unistd.h>

namespace macadam {
namespace {

/// Standard error, which is a file or pipe in this test.
class TextStyleOfAFile : public ::testing::Test {
protected:
    void SetUp() override {
        if (isatty(STDERR_FILENO) == 1) {
            GTEST_SKIP() << "standard error is a terminal";
        }
    }
    void TearDown() override {
        unsetenv("NO_COLOR");
        unsetenv("CLICOLOR_FORCE");
    }
    static std::string warning() { return styled(TextStyle::warning, "careful", STDERR_FILENO); }
};

TEST_F(TextStyleOfAFile, IsPlain) {
    EXPECT_EQ(warning(), "careful");
}

TEST_F(TextStyleOfAFile, IsColouredWhereThatIsForced) {
    setenv("CLICOLOR_FORCE", "1", 1);
    EXPECT_EQ(warning(), "\033[33mcareful\033[0m");
    EXPECT_EQ(styled(TextStyle::error, "no", STDERR_FILENO), "\033[31mno\033[0m");
    EXPECT_EQ(styled(TextStyle::heading, "", STDERR_FILENO), "");
    setenv("CLICOLOR_FORCE", "0", 1);
    EXPECT_EQ(warning(), "careful");
}

TEST_F(TextStyleOfAFile, IsPlainWithAnyNoColorThatIsNotEmpty) {
    setenv("CLICOLOR_FORCE", "1", 1);
    setenv("NO_COLOR", "0", 1);
    EXPECT_EQ(warning(), "careful");
    setenv("NO_COLOR", "", 1);
    EXPECT_EQ(warning(), "\033[33mcareful\033[0m");
}

} // namespace
} // namespace macadam
