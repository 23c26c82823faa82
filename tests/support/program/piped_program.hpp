#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace macadam::testing {

/// The built program between two pipes, as a shell would run it in the middle of a line.
class PipedProgram {
public:
    explicit PipedProgram(const std::vector<std::string>& words);
    PipedProgram(const PipedProgram&) = delete;
    PipedProgram& operator=(const PipedProgram&) = delete;
    ~PipedProgram(); ///< ends the program if it still runs

    void write(std::string_view text) const;
    void end_input();

    /// Without its newline; nothing if the output ends, or no line comes in time.
    std::optional<std::string> line(std::chrono::seconds wait_policy);

    void signal(int number) const;

    void close_output(); ///< as `head` does when it has seen enough

    struct End {
        int exit_status; ///< 128 + n if signal n ended it
        std::string err;
        double peak_mb; ///< of memory
    };
    End wait();

private:
    pid_t child_ = -1;
    int input_ = -1;
    int output_ = -1;
    std::string err_file_;
    std::string read_;
};

} // namespace macadam::testing
