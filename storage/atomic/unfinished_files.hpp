#pragma once

#include <filesystem>

namespace macadam {

/// Registers an unfinished file or folder for removal when a signal ends the program; see
/// remove_unfinished(). Not for data that must not be lost.
class RemovedIfCutOff {
public:
    explicit RemovedIfCutOff(const std::filesystem::path& name);
    RemovedIfCutOff(const RemovedIfCutOff&) = delete;
    RemovedIfCutOff& operator=(const RemovedIfCutOff&) = delete;
    ~RemovedIfCutOff() { release(); }

    /// Keeps the file from now on.
    void release();

private:
    int slot_;
};

/// Removes all files and folders that this process has registered, with their content. Safe in a
/// signal handler: it neither allocates nor locks.
void remove_unfinished() noexcept;

} // namespace macadam
