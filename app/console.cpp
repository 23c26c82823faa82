#include "app/console.hpp"

#include "app/printable.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include <unistd.h>

namespace macadam {
namespace {

constexpr int bar_width = 30;

void require_written(bool written) {
    if (!written) {
        throw InputError{fmt::format("standard output: {}", std::strerror(errno))};
    }
}

} // namespace

Console::Console(bool quiet, std::stop_token stop)
    : stop_{std::move(stop)}, quiet_{quiet}, terminal_{isatty(STDERR_FILENO) == 1} {}

void Console::say(std::string_view line) const {
    if (!quiet_) {
        std::fputs(fmt::format("{}\n", printable(line)).c_str(), stderr);
    }
}

void Console::warn(std::string_view line) const { // NOLINT(*-convert-member-functions-to-static)
    std::fputs(fmt::format("macadam: warning: {}\n", printable(line)).c_str(), stderr);
}

Progress Console::progress(std::string label) const {
    if (quiet_ || !terminal_) {
        return {.report = {}, .stop = stop_};
    }
    auto shown = std::make_shared<int>(-1);
    return {.report =
                [label = std::move(label), shown](std::size_t done, std::size_t whole) {
                    const int percent = whole == 0 ? 0 : static_cast<int>(100 * done / whole);
                    if (percent == *shown) {
                        return;
                    }
                    *shown = percent;
                    const int full = bar_width * percent / 100;
                    const auto bar = std::string(static_cast<std::size_t>(full), '=');
                    const auto line =
                        done == whole
                            ? std::string{"\r\033[K"}
                            : fmt::format("\r{} [{:<{}}] {:3d} %", label, bar, bar_width, percent);
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
    require_written(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void flush_results() {
    require_written(std::fflush(stdout) == 0);
}

} // namespace macadam
