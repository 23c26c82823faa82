#pragma once

#include "estimator/common/progress.hpp"

#include <cstddef>
#include <stop_token>
#include <string>
#include <string_view>

namespace macadam {

/// How a command speaks to people: talk and progress on standard error, never on standard output,
/// which holds results alone.
class Console {
public:
    /// \param quiet  only warnings and errors.
    /// \param stop   when the user wants the command to end
    explicit Console(bool quiet, std::stop_token stop = {});

    void say(std::string_view line) const;  ///< left out when quiet
    void warn(std::string_view line) const; ///< "macadam: warning: ..."

    /// A bar on a terminal, nothing elsewhere or when quiet. It goes when it is full. With the
    /// user's wish to stop.
    Progress progress(std::string label) const;

    const std::stop_token& stop() const { return stop_; }

private:
    std::stop_token stop_;
    bool quiet_;
    bool terminal_;
};

/// "1 trip", "2 trips".
std::string counted(std::size_t count, std::string_view one);

/// Results go out through here.
/// \throws InputError  if standard output cannot take them (a full disk, a closed file).
void print(std::string_view text);

/// The same for results that people read, such as tables: what names in them would do to a terminal
/// is spelled out (app/cli/terminal_escape.hpp).
void print_words(std::string_view text);

void flush_results();

} // namespace macadam
