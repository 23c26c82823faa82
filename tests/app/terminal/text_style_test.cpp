#include "app/terminal/text_style.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include <fcntl.h>
#include <unistd.h>

namespace macadam {
namespace {

class TextStyleOfAFile : public ::testing::Test {
protected:
    ~TextStyleOfAFile() override { ::close(file_); }
    void TearDown() override {
        unsetenv("NO_COLOR");
        unsetenv("CLICOLOR_FORCE");
    }
    std::string warning() const { return styled(TextStyle::warning, "careful", file_); }

private:
    int file_ = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
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
