#include "bounded_run.hpp"

#include "program.hpp"
#include "support/program/places.hpp"

#include <csignal>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

pid_t spawn(const std::filesystem::path& folder, const std::vector<std::string>& words) {
    std::vector<char*> argv{const_cast<char*>(program_file().c_str())};
    for (const auto& word : words) {
        argv.push_back(const_cast<char*>(word.c_str()));
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(
        &actions, STDERR_FILENO, "stderr.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = -1;
    const int error =
        posix_spawn(&child, program_file().c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        throw std::runtime_error{"cannot run " + program_file()};
    }
    return child;
}

} // namespace

BoundedRun run_bounded(const std::filesystem::path& folder,
                       const std::vector<std::string>& words,
                       std::chrono::seconds longest) {
    constexpr auto pause = std::chrono::milliseconds{5};
    const auto end = std::chrono::steady_clock::now() + longest;
    const pid_t child = spawn(folder, words);
    BoundedRun result{};
    int status = 0;
    rusage used{};
    while (wait4(child, &status, WNOHANG, &used) == 0) {
        if (!result.too_long && std::chrono::steady_clock::now() > end) {
            result.too_long = true;
            kill(child, SIGKILL);
        }
        std::this_thread::sleep_for(pause);
    }
    result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.peak_mb = static_cast<double>(used.ru_maxrss) / 1024;
    result.err = read_file(folder / "stderr.txt");
    return result;
}

} // namespace macadam::testing
