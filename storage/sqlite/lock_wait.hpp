#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

namespace macadam {

/// The process that keeps others from a file of SQLite's.
struct LockHolder {
    int process;
    std::string name; ///< "macadam calibrate"; of other programs their own short name
    bool is_ours;     ///< the same program
};

/// Who holds the lock that keeps others from writing the file, as the system tells it. Nothing
/// where nobody does, or where it does not tell: on network drives, and beyond Linux.
///
/// Asks for no lock itself and opens no file, for who closes a file gives up all locks that his
/// process has on it.
///
/// Source: proc_locks(5); where SQLite's locks lie: https://sqlite.org/fileformat2.html, 1.6, and
/// https://sqlite.org/walformat.html, 2.3.
std::optional<LockHolder> holder_of_lock(const std::filesystem::path& file);

/// How a program waits for its turn at a file that another one writes.
struct LockWaitPolicy {
    std::function<void(const std::string& words)> tell{}; ///< once a wait that lasts
    std::stop_token stop{};                               ///< ends the wait
    std::chrono::milliseconds tell_after{1'000};
    /// For a holder that gives no sign of life: a process of ours that takes no CPU time, any other
    /// program that commits nothing.
    std::chrono::milliseconds idle_limit{600'000};
};

/// Waits for a lock as long as its holder works.
class LockWait {
public:
    LockWait(std::filesystem::path file, LockWaitPolicy wait_policy);

    void set_lock_wait(LockWaitPolicy wait_policy) { wait_policy_ = std::move(wait_policy); }

    /// Sleeps a moment. \param pauses  how many there were before in this wait.
    /// \returns false if it is over: a stop was asked for, or the holder stands still.
    bool wait(int pauses);

    bool is_stop_wanted() const { return wait_policy_.stop.stop_requested(); }

    /// Of the wait that was given up, for a message; "is locked by ...".
    std::string reason() const;

private:
    using Clock = std::chrono::steady_clock;

    /// What changes while a holder works.
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
    bool told_ = false;
    bool stopped_ = false;
    bool gave_up_ = false;
};

} // namespace macadam
