#include "app/cli/console.hpp"

#include "app/cli/row_output.hpp"
#include "app/cli/terminal_escape.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <cerrno>
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

} // namespace

Console::Console(bool quiet, std::stop_token stop)
    : stop_{std::move(stop)}, quiet_{quiet}, terminal_{isatty(STDERR_FILENO) == 1} {}

void Console::say(std::string_view line) const {
    if (!quiet_) {
        clear_progress_bar();
        std::fputs(fmt::format("{}\n", printable(line)).c_str(), stderr);
    }
}

void Console::warn(std::string_view line) const { // NOLINT(*-convert-member-functions-to-static)
    clear_progress_bar();
    std::fputs(fmt::format("macadam: warning: {}\n", printable(line)).c_str(), stderr);
}

Progress Console::progress(std::string label, ProgressUnit unit) const {
    auto progress =
        quiet_ ? Progress{} : progress_display(std::move(label), std::move(unit), terminal_);
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
    clear_progress_bar();
    require_written(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void flush_results() {
    require_written(std::fflush(stdout) == 0);
}

} // namespace macadam
