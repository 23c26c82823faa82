#include "app/cli/console.hpp"

#include "app/cli/row_output.hpp"
#include "app/cli/terminal_escape.hpp"
#include "app/terminal/text_style.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include <unistd.h>

namespace macadam {
namespace {

constexpr int bar_width = 30;

using Clock = std::chrono::steady_clock;

/// Estimates the remaining time at the pace so far: ", 40 s left"; "" while that is too uncertain.
std::string time_left(Clock::duration passed, std::size_t done, std::size_t whole) {
    constexpr double enough_s = 3;
    constexpr double s_per_min = 60;
    const double passed_s = std::chrono::duration<double>(passed).count();
    if (passed_s < enough_s || done == 0 || done >= whole) {
        return {};
    }
    const double left_s = passed_s * static_cast<double>(whole - done) / static_cast<double>(done);
    return left_s < 2 * s_per_min ? fmt::format(", {:.0f} s left", left_s)
                                  : fmt::format(", {:.0f} min left", left_s / s_per_min);
}

void require_written(bool written) {
    if (!written) {
        throw InputError{fmt::format("standard output: {}", std::strerror(errno))};
    }
}

} // namespace

Console::Console(Verbosity verbosity, std::stop_token stop)
    : stop_{std::move(stop)}, verbosity_{verbosity}, terminal_{isatty(STDERR_FILENO) == 1} {}

void Console::say(std::string_view line) const {
    if (!is_quiet()) {
        std::fputs(fmt::format("{}\n", printable(line)).c_str(), stderr);
    }
}

void Console::detail(std::string_view line) const {
    if (verbosity_ == Verbosity::verbose) {
        const std::chrono::duration<double> passed = Clock::now() - begin_;
        std::fputs(fmt::format("[{:7.3f} s] {}\n", passed.count(), printable(line)).c_str(),
                   stderr);
    }
}

void Console::warn(std::string_view line) const { // NOLINT(*-convert-member-functions-to-static)
    const auto label = styled(TextStyle::warning, "macadam: warning:", STDERR_FILENO);
    std::fputs(fmt::format("{} {}\n", label, printable(line)).c_str(), stderr);
}

Progress Console::progress(std::string label) const {
    detail(label);
    if (is_quiet() || !terminal_) {
        return {.report = {}, .stop = stop_};
    }
    auto shown = std::make_shared<int>(-1);
    const auto begin = Clock::now();
    return {.report =
                [label = std::move(label), shown, begin](std::size_t done, std::size_t whole) {
                    const int percent = whole == 0 ? 0 : static_cast<int>(100 * done / whole);
                    if (percent == *shown) {
                        return;
                    }
                    *shown = percent;
                    const int full = bar_width * percent / 100;
                    const auto bar = std::string(static_cast<std::size_t>(full), '=');
                    const auto line =
                        done == whole ? std::string{"\r\033[K"}
                                      : fmt::format("\r{} [{:<{}}] {:3d} %{}\033[K",
                                                    label,
                                                    bar,
                                                    bar_width,
                                                    percent,
                                                    time_left(Clock::now() - begin, done, whole));
                    std::fputs(line.c_str(), stderr);
                    std::fflush(stderr);
                },
            .stop = stop_};
}

std::string counted(std::size_t count, std::string_view one) {
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : one.ends_with("s") ? "es" : "s");
}

void print_words(std::string_view text) {
    print(printable(text));
}

void print(std::string_view text) {
    if (RowOutput::write(text)) {
        return;
    }
    require_written(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void flush_results() {
    require_written(std::fflush(stdout) == 0);
}

} // namespace macadam
