#include "app/cli/memory_limit.hpp"

#include "storage/atomic/unfinished_files.hpp"

#include <fmt/format.h>

#include <array>
#include <csignal>
#include <string>

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

namespace macadam {
namespace {

std::string last_words;

[[maybe_unused]] void crashed(int /*signal*/) {
    remove_unfinished();
    [[maybe_unused]] const auto written =
        ::write(STDERR_FILENO, last_words.data(), last_words.size());
    ::_exit(1);
}

} // namespace

void bear_memory_limit(std::string_view command) {
#if !defined(__SANITIZE_ADDRESS__) // it has its own allocator and handlers
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return;
    }
    ::mallopt(M_ARENA_MAX, 1); // each further arena takes 64 MB of addresses, used or not

    constexpr rlim_t megabyte = 1'000'000;
    last_words = fmt::format("macadam {}: not enough memory: the address space is limited to "
                             "{} MB (ulimit -v), expected more\n",
                             command,
                             limit.rlim_cur / megabyte);
    static std::array<char, 65536> stack; // the regular stack may be unable to grow
    stack_t other{};
    other.ss_sp = stack.data();
    other.ss_size = stack.size();
    ::sigaltstack(&other, nullptr);
    struct sigaction action {};
    action.sa_handler = crashed;
    action.sa_flags = SA_ONSTACK;
    for (const int signal : {SIGSEGV, SIGABRT}) {
        ::sigaction(signal, &action, nullptr);
    }
#else
    static_cast<void>(command);
#endif
}

} // namespace macadam
