#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace macadam::testing {

/// Built program between two pipes, as in the middle of a shell pipeline.
class PipedProgram {
public:
    explicit PipedProgram(const std::vector<std::string>& words);
    PipedProgram(const PipedProgram&) = delete;
    PipedProgram& operator=(const PipedProgram&) = delete;
    ~PipedProgram(); ///< ends the program if it still runs

    void write(std::string_view text) const;
    void end_input();

    /// Returns the next line without its newline; `std::nullopt` if the output ends, or no line
    /// comes in time.
    std::optional<std::string> line(std::chrono::seconds timeout);

    void signal(int number) const;

    void close_output(); ///< as `head` does after enough lines

    struct End {
        int exit_status; ///< 128 + n if signal n ended it
        std::string err;
        double peak_mb; ///< peak memory
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
