#include "piped_program.hpp"

#include "program.hpp"
#include "support/program/places.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

struct Ends {
    int reading;
    int writing;
};

Ends new_pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        throw std::runtime_error{"no pipe"};
    }
    return {ends[0], ends[1]};
}

void close_once(int& descriptor) {
    if (const int open = std::exchange(descriptor, -1); open >= 0) {
        close(open);
    }
}

} // namespace

PipedProgram::PipedProgram(const std::vector<std::string>& words)
    : err_file_{::testing::TempDir() + "macadam_err_XXXXXX"} {
    close(mkostemp(err_file_.data(), O_CLOEXEC));
    const Ends in = new_pipe();
    const Ends out = new_pipe();
    std::vector<char*> argv{
        const_cast<char*>(program_file().c_str())}; // the child must take no memory
    for (const auto& word : words) {
        argv.push_back(const_cast<char*>(word.c_str()));
    }
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
        dup2(in.reading, STDIN_FILENO);
        dup2(out.writing, STDOUT_FILENO);
        dup2(open(err_file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600),
             STDERR_FILENO);
        std::signal(SIGPIPE, SIG_DFL);
        execv(program_file().c_str(), argv.data());
        _exit(127);
    }
    close(in.reading);
    close(out.writing);
    input_ = in.writing;
    output_ = out.reading;
    std::signal(SIGPIPE, SIG_IGN); // the program may end before it has read everything
}

PipedProgram::~PipedProgram() {
    unlink(err_file_.c_str());
    close_once(input_);
    close_once(output_);
    if (child_ > 0) {
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }
}

void PipedProgram::write(std::string_view text) const {
    while (!text.empty()) {
        const auto count = ::write(input_, text.data(), text.size());
        if (count < 0) {
            return; // nobody reads any more
        }
        text.remove_prefix(static_cast<std::size_t>(count));
    }
}

void PipedProgram::end_input() {
    close_once(input_);
}

std::optional<std::string> PipedProgram::line(std::chrono::seconds timeout) {
    for (;;) {
        if (const auto size = read_.find('\n'); size != std::string::npos) {
            auto line = read_.substr(0, size);
            read_.erase(0, size + 1);
            return line;
        }
        pollfd ready{output_, POLLIN, 0};
        const auto wait_ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout);
        std::array<char, 4096> block{};
        if (poll(&ready, 1, static_cast<int>(wait_ms.count())) <= 0) {
            return std::nullopt;
        }
        const auto count = read(output_, block.data(), block.size());
        if (count <= 0) {
            return std::nullopt;
        }
        read_.append(block.data(), static_cast<std::size_t>(count));
    }
}

void PipedProgram::signal(int number) const {
    kill(child_, number);
}

void PipedProgram::close_output() {
    close_once(output_);
}

PipedProgram::End PipedProgram::wait() {
    int status = 0;
    rusage used{};
    wait4(std::exchange(child_, -1), &status, 0, &used);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            read_file(err_file_),
            static_cast<double>(used.ru_maxrss) / 1024};
}

} // namespace macadam::testing
