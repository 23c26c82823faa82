#pragma once

#include <chrono>
#include <stop_token>
#include <string_view>

namespace macadam {

/// Behaviour of a command when it is told to stop.
struct InterruptConfig {
    bool is_quiet = false;           ///< without the acknowledgement of the signal
    bool runs_until_stopped = false; ///< a signal is the ordinary end: exit status 0
};

/// Signal handling for as long as the object lives. Ctrl-C, `kill` and a closing terminal (INT,
/// TERM, HUP) request a stop through `stop()` and are acknowledged at once. A command that has not
/// ended within 1.5 s (0.3 s if it writes to no database) is terminated with a message and exit
/// status 1. Its unfinished files are removed (storage/atomic/unfinished_files.hpp), and its
/// uncommitted database changes are rolled back when the database is opened next. A second signal
/// terminates at once. Signals ignored at program start, as under `nohup`, stay ignored.
///
/// SIGPIPE also removes unfinished files when the reader of the output has gone. SIGBUS ends the
/// program with a message and exit status 1: a file mapped into memory was cut short by others.
///
/// Uses no thread, so processes may be forked beside it. Only one object may exist at a time.
class InterruptHandler {
public:
    /// \param command  name of the command in messages
    explicit InterruptHandler(std::string_view command, InterruptConfig config = {});
    InterruptHandler(const InterruptHandler&) = delete;
    InterruptHandler& operator=(const InterruptHandler&) = delete;
    ~InterruptHandler();

    std::stop_token stop() const;

    /// Time limit for a command to end by itself: 1.5 s; longer under sanitizers.
    static std::chrono::milliseconds grace_period();
};

} // namespace macadam
