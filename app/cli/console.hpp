#pragma once

#include "app/progress/progress_display.hpp"
#include "estimator/common/progress.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>

namespace macadam {

enum class Verbosity : std::uint8_t { quiet, normal, verbose };

/// Messages and progress for people, on standard error only; standard output is reserved for
/// results.
class Console {
public:
    /// \param verbosity  quiet suppresses all but warnings and errors; verbose adds details
    /// \param stop       requested when the user wants the command to end
    explicit Console(Verbosity verbosity, std::stop_token stop = {});

    void say(std::string_view line) const; ///< suppressed when quiet

    /// Tells what the command reads, chooses and does, after the seconds since its start; only when
    /// verbose.
    void detail(std::string_view line) const;
    void warn(std::string_view line) const; ///< "macadam: warning: ..."

    /// Returns a progress display (app/progress/progress_display.hpp), silent when quiet. The
    /// result carries the user's stop token.
    Progress progress(std::string label, ProgressUnit unit = {}) const;

    const std::stop_token& stop() const { return stop_; }
    bool is_quiet() const { return verbosity_ == Verbosity::quiet; }

private:
    std::stop_token stop_;
    Verbosity verbosity_;
    bool terminal_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Formats a count with its noun: "1 trip", "2 trips".
std::string counted(std::size_t count, std::string_view one);

/// Writes results to standard output.
/// \throws InputError  if standard output fails (a full disk, a closed file).
void print(std::string_view text);

/// Writes results for people, such as tables; characters that would control a terminal are escaped
/// (app/cli/terminal_escape.hpp).
void print_words(std::string_view text);

void flush_results();

} // namespace macadam
