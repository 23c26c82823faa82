#pragma once

#include <chrono>
#include <stop_token>
#include <string_view>

namespace macadam {

/// While it lives, Ctrl-C, `kill` and a terminal that closes (INT, TERM, HUP) ask the command to
/// come to an end of its own: `stop()` says so. Where it has not within 1.5 s (0.3 s
/// if it writes to no database), it is ended with words and exit status 1; what it had begun is
/// removed (storage/atomic/unfinished_files.hpp), and what it had not committed to a database is
/// undone by who opens that next. A second signal cuts off at once. A signal that was ignored when
/// the program began, as under `nohup`, stays so.
///
/// SIGPIPE, when the reader of the output has gone, removes what was begun likewise.
///
/// It needs no thread, and processes may be forked beside it. One at a time.
class Interruption {
public:
    /// \param command  whose words these are
    explicit Interruption(std::string_view command);
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;
    ~Interruption();

    std::stop_token stop() const;

    /// Time that a command may take to end by itself: 1.5 s; more under sanitizers.
    static std::chrono::milliseconds wait_policy();
};

} // namespace macadam
