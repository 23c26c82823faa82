#include "storage/sqlite/lock_wait.hpp"

#include "estimator/common/exact_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// All waiting programs poll equally often, so that each finds the pauses between the transactions
// of another (dirty_fusion.cpp); SQLite's own pauses grow to 100 ms.
constexpr auto pause = 5ms;
constexpr auto look_every = 200ms; // interval of checking the lock holder

// A stopped program first completes its work, for which it may briefly need the lock.
constexpr auto wait_though_stopped = 1s;

/// Byte range of a file.
struct Range {
    std::int64_t first;
    std::int64_t last;
};

bool meet(const Range& a, const Range& b) {
    return a.first <= b.last && b.first <= a.last;
}

constexpr Range log_writer{120, 122};                // of "-shm": writing, checkpointing, recovery
constexpr Range file_writer{0x40000000, 0x40000001}; // pending and reserved
constexpr Range file_users{0x40000002, 0x40000002 + 510 - 1};

struct Lock {
    int process;
    bool excludes; ///< false: shared
    std::uint64_t inode;
    Range bytes;
};

std::int64_t whole_number(std::string_view text) {
    return exact_number<std::int64_t>(text).value_or(-1);
}

/// Parses a line such as "1: POSIX  ADVISORY  WRITE 19780 fe:00:10952885 120 120"; `std::nullopt`
/// for a lock that is only waited for.
std::optional<Lock> lock_in(const std::string& line) {
    std::istringstream in{line};
    std::array<std::string, 8> words;
    for (auto& word : words) {
        in >> word;
    }
    const auto& [number, kind, advisory, mode, process, inode, first, last] = words;
    if (kind != "POSIX" && kind != "OFDLCK") {
        return std::nullopt;
    }
    constexpr auto to_end = std::int64_t{1} << 62;
    // Devices are ignored: on some file systems they differ from those of stat().
    return Lock{.process = static_cast<int>(whole_number(process)),
                .excludes = mode == "WRITE",
                .inode = static_cast<std::uint64_t>(
                    whole_number(std::string_view{inode}.substr(inode.rfind(':') + 1))),
                .bytes = {whole_number(first), last == "EOF" ? to_end : whole_number(last)}};
}

std::vector<Lock> all_locks() {
    std::ifstream in{"/proc/locks"};
    std::vector<Lock> locks;
    for (std::string line; std::getline(in, line);) {
        if (const auto lock = lock_in(line)) {
            locks.push_back(*lock);
        }
    }
    return locks;
}

std::uint64_t inode_of(const fs::path& file) {
    struct stat status {};
    return stat(file.c_str(), &status) == 0 ? status.st_ino : 0;
}

fs::path beside(fs::path file, const char* suffix) {
    file += suffix;
    return file;
}

std::string content_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

fs::path folder_of(int process) {
    return fs::path{"/proc"} / std::to_string(process);
}

std::string short_name_of(int process) {
    auto name = content_of(folder_of(process) / "comm");
    while (!name.empty() && name.back() == '\n') {
        name.pop_back();
    }
    return name;
}

bool runs_this_program(int process, const std::string& name) {
    std::error_code ignored;
    return name == "macadam" ||
           fs::equivalent(folder_of(process) / "exe", "/proc/self/exe", ignored);
}

/// Name of a process with its command, the word after the name.
std::string name_text(int process, const std::string& name) {
    const auto words = content_of(folder_of(process) / "cmdline");
    const auto begin = words.find('\0');
    if (name != "macadam" || begin == std::string::npos) {
        return name;
    }
    const std::string command{words.c_str() + begin + 1};
    return command.empty() ? name : name + " " + command;
}

/// Fields of proc_pid_stat(5) from the third on; the second holds a name in brackets with arbitrary
/// characters.
std::istringstream fields_of(int process) {
    const auto text = content_of(folder_of(process) / "stat");
    return std::istringstream{text.substr(std::min(text.size(), text.rfind(')') + 1))};
}

/// Tests whether a process is stopped by SIGSTOP, Ctrl-Z or a debugger.
bool is_stopped(int process) {
    std::string state;
    fields_of(process) >> state;
    return state == "T" || state == "t";
}

/// CPU ticks of a process: fields 14 and 15 of proc_pid_stat(5).
std::uint64_t cpu_time_of(int process) {
    auto in = fields_of(process);
    std::string skipped;
    for (int field = 3; field < 14; ++field) {
        in >> skipped;
    }
    std::uint64_t user = 0, system = 0;
    in >> user >> system;
    return user + system;
}

/// Fingerprint of a file that changes with every commit.
std::uint64_t print_of(const fs::path& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) {
        return 0;
    }
    constexpr std::uint64_t odd = 1'000'003;
    return (static_cast<std::uint64_t>(status.st_size) * odd +
            static_cast<std::uint64_t>(status.st_mtim.tv_sec)) *
               odd +
           static_cast<std::uint64_t>(status.st_mtim.tv_nsec);
}

} // namespace

std::optional<LockHolder> holder_of_lock(const fs::path& file) {
    const auto locks = all_locks();
    const auto find = [&](const fs::path& name, const Range& bytes, bool excludes) {
        const auto inode = inode_of(name);
        for (const auto& lock : locks) {
            if (inode != 0 && lock.inode == inode && lock.excludes >= excludes &&
                lock.process > 0 && lock.process != getpid() && meet(lock.bytes, bytes)) {
                return lock.process;
            }
        }
        return 0;
    };
    int process = find(beside(file, "-shm"), log_writer, true);
    process = process != 0 ? process : find(file, file_writer, true);
    if (process == 0 && inode_of(beside(file, "-shm")) == 0) { // a commit waits for readers
        process = find(file, file_users, false);
    }
    if (process == 0) {
        return std::nullopt;
    }
    const auto name = short_name_of(process);
    return LockHolder{process, name_text(process, name), runs_this_program(process, name)};
}

LockWait::LockWait(fs::path file, LockWaitPolicy wait_policy)
    : file_{std::move(file)}, wait_policy_{std::move(wait_policy)} {}

void LockWait::begin() {
    began_ = looked_ = alive_ = Clock::now();
    sign_ = {};
    holder_.reset();
    announced_ = stopped_ = gave_up_ = false;
}

bool LockWait::wait(int pauses) {
    if (pauses == 0) {
        begin();
    }
    const auto now = Clock::now();
    if (wait_policy_.stop.stop_requested() && now - began_ >= wait_though_stopped) {
        holder_ = holder_of_lock(file_);
        stopped_ = true;
        return false;
    }
    if (now - looked_ >= std::min<Clock::duration>(look_every, wait_policy_.idle_limit) &&
        has_stood_still(now)) {
        gave_up_ = true;
        return false;
    }
    if (!announced_ && wait_policy_.tell && now - began_ >= wait_policy_.tell_after) {
        announced_ = true;
        holder_ = holder_of_lock(file_);
        wait_policy_.tell(fmt::format("waiting for {}, {}; press Ctrl-C to stop waiting",
                                      holder_text(),
                                      holder_ && is_stopped(holder_->process)
                                          ? "which is stopped ('kill -CONT' resumes it)"
                                          : "which is using the database"));
    }
    std::this_thread::sleep_for(pause);
    return true;
}

bool LockWait::has_stood_still(Clock::time_point now) {
    looked_ = now;
    holder_ = holder_of_lock(file_);
    if (const auto sign = sign_of_life(); sign != sign_) {
        sign_ = sign;
        alive_ = now;
    }
    return now - alive_ >= wait_policy_.idle_limit;
}

LockWait::Sign LockWait::sign_of_life() const {
    if (holder_ && holder_->is_ours) {
        return {holder_->process, cpu_time_of(holder_->process)};
    }
    return {holder_ ? holder_->process : 0,
            print_of(file_) + 3 * print_of(beside(file_, "-wal")) +
                5 * print_of(beside(file_, "-journal"))};
}

std::string LockWait::holder_text() const {
    return holder_ ? fmt::format("'{}' (process {})", holder_->name, holder_->process)
                   : std::string{"another program"};
}

std::string LockWait::reason() const {
    if (stopped_) {
        return fmt::format("interrupted while waiting for {}; nothing more was written",
                           holder_text());
    }
    if (!gave_up_) {
        return "is locked by another program";
    }
    const auto idle = std::chrono::duration_cast<std::chrono::seconds>(wait_policy_.idle_limit);
    return fmt::format("is locked by {}, which has made no progress for {}; nothing more was "
                       "written, end that program and run this command again",
                       holder_text(),
                       idle < 60s ? fmt::format("{} s", idle.count())
                                  : fmt::format("{} minutes", idle.count() / 60));
}

} // namespace macadam
