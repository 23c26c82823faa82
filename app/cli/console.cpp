#include "app/cli/console.hpp"

#include "app/capture/result_capture.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/terminal_escape.hpp"
#include "app/terminal/text_style.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <utility>

#include <unistd.h>

namespace macadam {
namespace {

void require_written(bool written) {
    if (!written) {
        throw InputError{fmt::format("standard output: {}", std::strerror(errno))};
    }
}

/// Hands a message to the caller within the process that captures results, if there is one.
bool is_captured(bool is_warning, std::string_view line) {
    auto* const capture = ResultCapture::current();
    if (capture != nullptr) {
        capture->add_message(is_warning, line);
    }
    return capture != nullptr;
}

} // namespace

Console::Console(Verbosity verbosity, std::stop_token stop)
    : stop_{std::move(stop)}, verbosity_{verbosity}, terminal_{isatty(STDERR_FILENO) == 1} {}

void Console::say(std::string_view line) const {
    if (!is_captured(false, line) && !is_quiet()) {
        clear_progress_bar();
        std::fputs(fmt::format("{}\n", printable(line)).c_str(), stderr);
    }
}

void Console::detail(std::string_view line) const {
    if (verbosity_ == Verbosity::verbose) {
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
        clear_progress_bar();
        std::fputs(fmt::format("[{:7.3f} s] {}\n", passed.count(), printable(line)).c_str(),
                   stderr);
    }
}

void Console::warn(std::string_view line) const { // NOLINT(*-convert-member-functions-to-static)
    if (is_captured(true, line)) {
        return;
    }
    clear_progress_bar();
    const auto label = styled(TextStyle::warning, "macadam: warning:", STDERR_FILENO);
    std::fputs(fmt::format("{} {}\n", label, printable(line)).c_str(), stderr);
}

Progress Console::progress(std::string label, ProgressUnit unit) const {
    detail(label);
    auto progress =
        is_quiet() ? Progress{} : progress_display(std::move(label), std::move(unit), terminal_);
    progress.stop = stop_;
    return progress;
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
    if (auto* const capture = ResultCapture::current(); capture != nullptr) {
        capture->add_text(text);
        return;
    }
    clear_progress_bar();
    require_written(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void flush_results() {
    require_written(std::fflush(stdout) == 0);
}

} // namespace macadam
