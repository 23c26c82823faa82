#pragma once

#include "storage/sqlite/lock_wait_policy.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace macadam {

/// Process that holds a lock on an SQLite file.
struct LockHolder {
    int process;
    std::string name; ///< "macadam calibrate"; for other programs their short name
    bool is_ours;     ///< whether it is the same program
};

/// Identifies the process whose lock prevents others from writing the file. Returns `std::nullopt`
/// if there is none, or if the system does not tell: on network drives, and on systems other than
/// Linux.
///
/// Takes no lock and does not open the file, because closing a file drops all locks that the
/// process holds on it.
///
/// Source: proc_locks(5); positions of SQLite's locks: https://sqlite.org/fileformat2.html, 1.6,
/// and https://sqlite.org/walformat.html, 2.3.
std::optional<LockHolder> holder_of_lock(const std::filesystem::path& file);

/// Waits for a lock for as long as its holder makes progress.
class LockWait {
public:
    LockWait(std::filesystem::path file, LockWaitPolicy wait_policy);

    void set_lock_wait(LockWaitPolicy wait_policy) { wait_policy_ = std::move(wait_policy); }

    /// Sleeps briefly.
    ///
    /// \param pauses  number of pauses before in this wait.
    /// \returns false if the wait is over: a stop was requested, or the holder is idle.
    bool wait(int pauses);

    bool is_stop_wanted() const { return wait_policy_.stop.stop_requested(); }

    /// Reason for which the wait was given up, for a message: "is locked by ...".
    std::string reason() const;

private:
    using Clock = std::chrono::steady_clock;

    /// Values that change while a holder makes progress.
    struct Sign {
        int process;
        std::uint64_t work;
        friend bool operator==(const Sign&, const Sign&) = default;
    };

    void begin();
    bool has_stood_still(Clock::time_point now);
    Sign sign_of_life() const;
    std::string holder_text() const;

    std::filesystem::path file_;
    LockWaitPolicy wait_policy_;
    Clock::time_point began_{};
    Clock::time_point looked_{};
    Clock::time_point alive_{};
    Sign sign_{};
    std::optional<LockHolder> holder_;
    bool announced_ = false;
    bool stopped_ = false;
    bool gave_up_ = false;
};

} // namespace macadam
