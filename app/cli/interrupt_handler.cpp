#include "app/cli/interrupt_handler.hpp"

#include "storage/atomic/unfinished_files.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <optional>
#include <string>

#include <sys/time.h>
#include <unistd.h>

namespace macadam {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr int slowness = 20; // factor under sanitizers, on a machine that is busy with tests
#else
constexpr int slowness = 1;
#endif

// Time limits for a command to end by itself. Together with the removal of files, the total must
// stay below 2 s. A command that only reads has little to finish.
constexpr int grace_ms = 1500 * slowness;
constexpr int reader_wait_ms = 300 * slowness;

constexpr std::array interrupting{SIGINT, SIGTERM, SIGHUP};

/// State of the signal handlers, which may run at any moment, in any thread.
struct Wish {
    /// A stop request takes no lock as long as no std::stop_callback is registered.
    std::optional<std::stop_source> stop;
    std::string acknowledgement; ///< "" when quiet
    std::string last_words;
    std::string words_on_lost_file;
    int last_status = 1;
    pid_t process = 0; ///< forked processes handle signals themselves
    std::atomic<bool> is_known = false;
};
Wish wish;

std::array<struct sigaction, interrupting.size()> before;
struct sigaction before_of_pipe;
struct sigaction before_of_lost_file;

void wake_after(int time_ms) {
    itimerval timer{};
    timer.it_value = {.tv_sec = time_ms / 1000, .tv_usec = suseconds_t{time_ms % 1000} * 1000};
    ::setitimer(ITIMER_REAL, &timer, nullptr);
}

void say(const std::string& words) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words.data(), words.size());
}

/// Removes unfinished files and ends the process by the signal's default action.
void cut_off(int signal) {
    remove_unfinished();
    std::signal(signal, SIG_DFL);
    ::raise(signal); // delivered when the handler returns
}

void interrupted(int signal) {
    const int error = errno;
    if (wish.process != ::getpid() || wish.is_known.exchange(true)) {
        cut_off(signal);
    } else {
        wish.stop->request_stop();
        say(wish.acknowledgement);
        wake_after(databases_open_for_writing() > 0 ? grace_ms : reader_wait_ms);
    }
    errno = error;
}

void end_of_wait(int /*signal*/) {
    remove_unfinished();
    say(wish.last_words);
    ::_exit(wish.last_status);
}

void end_on_lost_file(int /*signal*/) {
    remove_unfinished();
    say(wish.words_on_lost_file);
    ::_exit(1);
}

/// Installs a handler that blocks the other signals while it runs.
void handle(int signal, void (*handler)(int), struct sigaction* replaced) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    for (const int other : interrupting) {
        sigaddset(&action.sa_mask, other);
    }
    sigaddset(&action.sa_mask, SIGALRM);
    ::sigaction(signal, &action, replaced);
}

} // namespace

InterruptHandler::InterruptHandler(std::string_view command, InterruptConfig config) {
    wish.stop.emplace();
    const auto* const clear_bar = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
    wish.acknowledgement = config.is_quiet
                               ? std::string{}
                               : fmt::format("{}macadam {}: stopping; press Ctrl-C again to stop "
                                             "at once\n",
                                             clear_bar,
                                             command);
    wish.last_words = fmt::format(
        "{}macadam {}: interrupted; unfinished work was discarded\n", clear_bar, command);
    wish.words_on_lost_file =
        fmt::format("{}macadam {}: a file that it was reading was cut short or cannot be read any "
                    "more; run the command again\n",
                    clear_bar,
                    command);
    wish.last_status = config.runs_until_stopped ? 0 : 1;
    wish.process = ::getpid();
    wish.is_known = false;
    handle(SIGALRM, end_of_wait, nullptr);
    handle(SIGBUS, end_on_lost_file, &before_of_lost_file);
    handle(SIGPIPE, cut_off, &before_of_pipe);
    if (before_of_pipe.sa_handler == SIG_IGN) {
        std::signal(SIGPIPE, SIG_IGN);
    }
    for (std::size_t i = 0; i < interrupting.size(); ++i) {
        handle(interrupting[i], interrupted, &before[i]);
        if (before[i].sa_handler == SIG_IGN) {
            std::signal(interrupting[i], SIG_IGN);
        }
    }
}

InterruptHandler::~InterruptHandler() {
    for (std::size_t i = 0; i < interrupting.size(); ++i) {
        ::sigaction(interrupting[i], &before[i], nullptr);
    }
    wake_after(0);
    std::signal(SIGALRM, SIG_DFL);
    ::sigaction(SIGPIPE, &before_of_pipe, nullptr);
    ::sigaction(SIGBUS, &before_of_lost_file, nullptr);
}

std::chrono::milliseconds InterruptHandler::grace_period() {
    return std::chrono::milliseconds{grace_ms};
}

// Refers to global state, but only one object exists at a time.
std::stop_token InterruptHandler::stop() const { // NOLINT(*-convert-member-functions-to-static)
    return wish.stop->get_token();
}

} // namespace macadam
