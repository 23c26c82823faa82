// Main function of every test program: GoogleTest, and a limit of time for each test that leaves a
// stack.

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <execinfo.h>
#include <unistd.h>

namespace {

/// Says which functions the process was in, and ends it. (The stack of another thread than the one
/// that the system chose for the signal is not told.)
void end_with_stack(int /*signal*/) {
    constexpr std::string_view words{"\nthe test has reached its time limit, in:\n"};
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words.data(), words.size());
    std::array<void*, 64> frames{};
    const int depth = ::backtrace(frames.data(), int{frames.size()});
    ::backtrace_symbols_fd(frames.data(), depth, STDERR_FILENO);
    ::_exit(124); // as the command timeout
}

/// Gives each test of the process the same time.
class TimeLimit : public ::testing::EmptyTestEventListener {
public:
    explicit TimeLimit(unsigned limit_s) : limit_s_{limit_s} {
        std::array<void*, 1> frame{};
        ::backtrace(frame.data(), 1); // loads its library now, not in the handler
        std::signal(SIGALRM, end_with_stack);
    }

    void OnTestStart(const ::testing::TestInfo& /*test*/) override { ::alarm(limit_s_); }
    void OnTestProgramEnd(const ::testing::UnitTest& /*tests*/) override {
        ::alarm(limit_s_); // for what is destroyed, and for the search for leaks
    }

private:
    unsigned limit_s_;
};

/// Takes `--time-limit=SECONDS`, of each test, from the command line.
void set_time_limit(int argc, char** argv) {
    constexpr std::string_view name{"--time-limit="};
    if (argc < 2 || !std::string_view{argv[argc - 1]}.starts_with(name)) {
        return;
    }
    const std::string_view text = std::string_view{argv[argc - 1]}.substr(name.size());
    unsigned limit_s = 0;
    std::from_chars(text.data(), text.data() + text.size(), limit_s);
    ::testing::UnitTest::GetInstance()->listeners().Append(new TimeLimit{limit_s}); // which owns it
}

/// Keeps the developer's own settings from the program under test: its configuration file,
/// variables with defaults of options, and colours.
void forget_own_settings() {
    constexpr std::string_view ours{"MACADAM_"};
    constexpr std::array tests{std::string_view{"MACADAM_TEST_"},
                               std::string_view{"MACADAM_LEAVE_"}};
    std::vector<std::string> names{"NO_COLOR", "CLICOLOR_FORCE"};
    for (auto** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view text{*variable};
        const bool is_of_tests = std::ranges::any_of(
            tests, [&](std::string_view prefix) { return text.starts_with(prefix); });
        if (text.starts_with(ours) && !is_of_tests) {
            names.emplace_back(text.substr(0, text.find('=')));
        }
    }
    for (const auto& name : names) {
        ::unsetenv(name.c_str());
    }
    ::setenv("XDG_CONFIG_HOME", "/dev/null", 1); // holds no file
}

} // namespace

int main(int argc, char** argv) {
    forget_own_settings();
    ::testing::InitGoogleMock(&argc, argv);
    set_time_limit(argc, argv);
    return RUN_ALL_TESTS();
}
