#include "program.hpp"
#include "support/program/places.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

void redirect(const fs::path& file, int to) {
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(descriptor, to);
    close(descriptor);
}

/// A name that no other run has, of this program or of another.
fs::path own_file(const std::string& kind) {
    static std::atomic<int> runs = 0;
    return fs::path{::testing::TempDir()} /
           ("macadam_" + kind + "_" + std::to_string(getpid()) + "_" + std::to_string(++runs));
}

/// The words of a command line as the system takes them; they point into `words`.
std::vector<char*> argv_of(const std::vector<std::string>& words) {
    std::vector<char*> argv{const_cast<char*>(program_file().c_str())};
    for (const auto& word : words) {
        argv.push_back(const_cast<char*>(word.c_str()));
    }
    argv.push_back(nullptr);
    return argv;
}

/// Takes no memory: another thread may have held the lock of all memory when this process began.
[[noreturn]] void become_macadam(const std::vector<char*>& argv,
                                 const fs::path& out,
                                 const fs::path& err,
                                 const Limit& limit) {
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    if (limit.most > 0) {
        std::signal(SIGXFSZ, SIG_DFL); // what it does then is the program's part
        const rlimit both{limit.most, limit.most};
        setrlimit(static_cast<__rlimit_resource_t>(limit.resource), &both);
    }
    execv(program_file().c_str(), argv.data());
    _exit(127);
}

Run run(const std::vector<std::string>& words,
        const fs::path& out,
        const Limit& limit,
        const std::function<void(pid_t child)>& meanwhile = {}) {
    const auto err = own_file("err");
    const auto argv = argv_of(words);
    const pid_t child = fork();
    if (child == 0) {
        become_macadam(argv, out, err, limit);
    }
    if (child > 0 && meanwhile) {
        meanwhile(child);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
        throw std::runtime_error{"cannot run " + program_file()};
    }
    Run result{
        WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), "", read_file(err)};
    fs::remove(err);
    return result;
}

Run signalled(const std::vector<std::string>& words,
              const fs::path& out,
              const std::function<bool()>& is_time,
              int signal) {
    auto result = run(words, out, {}, [&](pid_t child) {
        constexpr auto pause = std::chrono::milliseconds{2};
        siginfo_t ended{};
        while (!is_time() && ended.si_pid != child) {
            std::this_thread::sleep_for(pause);
            waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
        }
        kill(child, signal);
    });
    result.out = read_file(out);
    fs::remove(out);
    return result;
}

} // namespace

Run run_macadam(const std::vector<std::string>& words, std::size_t max_file_bytes) {
    return run_macadam_limited(words, {RLIMIT_FSIZE, max_file_bytes});
}

Run run_macadam_limited(const std::vector<std::string>& words, const Limit& limit) {
    const auto out = own_file("out");
    auto result = run(words, out, limit);
    result.out = read_file(out);
    fs::remove(out);
    return result;
}

Run run_macadam_signalled(const std::vector<std::string>& words,
                          const std::string& words_before,
                          int signal) {
    const auto out = own_file("out");
    return signalled(
        words, out, [&] { return read_file(out).find(words_before) != std::string::npos; }, signal);
}

Run run_macadam_signalled(const std::vector<std::string>& words,
                          const std::function<bool()>& is_time,
                          int signal) {
    return signalled(words, own_file("out"), is_time, signal);
}

Run run_macadam_into(const fs::path& out, const std::vector<std::string>& words) {
    return run(words, out, {});
}

fs::path fresh_folder() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    const auto folder = fs::path{::testing::TempDir()} /
                        ("macadam_" + std::string{test->test_suite_name()} + "_" + test->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

std::string read_file(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream{file, std::ios::binary}.rdbuf();
    return text.str();
}

void write_file(const fs::path& file, const std::string& text) {
    std::ofstream{file, std::ios::binary} << text;
}

} // namespace macadam::testing
