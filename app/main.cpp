#include "app/cli/commands.hpp"
#include "app/cli/memory_limit.hpp"
#include "app/cli/terminal_escape.hpp"
#include "app/config/config_help.hpp"
#include "app/config/user_defaults.hpp"
#include "app/progress/progress_display.hpp"
#include "app/terminal/text_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include <malloc.h>
#include <unistd.h>

namespace {

/// Writes to standard error; a failure there cannot be reported.
/// \param name   of the program or command that failed, in the colour of errors
void say(std::string_view name, const std::string& words) {
    macadam::clear_progress_bar();
    const auto label = macadam::styled(macadam::TextStyle::error, name, STDERR_FILENO);
    std::fputs(fmt::format("{}: {}", label, macadam::printable(words)).c_str(), stderr);
}

enum ExitStatus { done = 0, failed = 1, misused = 2 };

/// Writes help and similar texts to standard output.
int tell(const std::string& words) {
    const bool written = std::fputs(words.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
    return written ? done : failed;
}

int refuse_command(std::string_view name) {
    say("macadam", fmt::format("{}\n", macadam::refusal_of_command(name)));
    return misused;
}

/// Answers `macadam help [COMMAND]`.
int help_on(const std::vector<std::string>& words) {
    if (words.empty() || words.front().starts_with('-')) {
        return tell(macadam::help_of_all(STDOUT_FILENO));
    }
    if (words.front() == "config") {
        return tell(macadam::config_help());
    }
    const auto* const command = macadam::command_named(words.front());
    return command == nullptr ? refuse_command(words.front()) : tell(macadam::help_of(*command));
}

/// Runs a command and converts exceptions to a message and an exit status; the only place to do so.
int run_command(const macadam::Command& command, std::vector<std::string> words) {
    const auto name = fmt::format("macadam {}", command.name);
    try {
        const auto defaults = macadam::user_defaults(command);
        macadam::run(command, std::move(words), defaults);
        return done;
    } catch (const macadam::UsageError& error) {
        say(name,
            fmt::format("{}\nusage: {}\nmore:  macadam {} --help\n",
                        error.what(),
                        macadam::usage_of(command),
                        command.name));
        return misused;
    } catch (const std::bad_alloc&) {
        say(name, "not enough memory\n");
        return failed;
    } catch (const std::exception& error) {
        say(name, fmt::format("{}\n", error.what()));
        return failed;
    }
}

} // namespace

int main(int argc, char** argv) {
    // The samples of a long trip are a few large blocks. Outside the heap, each returns to the
    // system when it is freed instead of leaving a hole. This saves a fifth of the memory of a
    // ten-hour trip.
    constexpr int large_block_bytes = 1 << 20;
    mallopt(M_MMAP_THRESHOLD, large_block_bytes);

    std::signal(SIGXFSZ, SIG_IGN); // the file size limit becomes a write error

    std::vector<std::string> words{argv + 1, argv + argc};
    if (words.empty()) {
        std::fputs(macadam::help_of_all(STDERR_FILENO).c_str(), stderr);
        return misused;
    }
    const auto name = words.front();
    words.erase(words.begin());

    if (name == "--version" || name == "-V") {
        return tell(fmt::format("macadam {}\n", MACADAM_VERSION));
    }
    if (name == "--help" || name == "-h" || name == "--help-all" || name == "help") {
        return help_on(words);
    }
    const auto* const command = macadam::command_named(name);
    if (command == nullptr) {
        return refuse_command(name);
    }
    const auto given = [&](std::string_view word) {
        return std::ranges::find(words, word) != words.end();
    };
    if (given("--help-all")) {
        return tell(macadam::help_of(*command, macadam::HelpDetail::all));
    }
    if (given("--help") || given("-h")) {
        return tell(macadam::help_of(*command));
    }
    macadam::bear_memory_limit(name);
    return run_command(*command, std::move(words));
}
