#pragma once

#include <filesystem>

namespace macadam {

/// The name of an unfinished file or folder, which goes also where the program is cut off: see
/// remove_unfinished(). Not of what must not be lost.
class RemovedIfCutOff {
public:
    explicit RemovedIfCutOff(const std::filesystem::path& name);
    RemovedIfCutOff(const RemovedIfCutOff&) = delete;
    RemovedIfCutOff& operator=(const RemovedIfCutOff&) = delete;
    ~RemovedIfCutOff() { release(); }

    /// From now on it stays.
    void release();

private:
    int slot_;
};

/// Removes all files and folders of that kind that this process has at the moment, with what is in
/// them. May be called by a signal handler: it takes no memory and no lock.
void remove_unfinished() noexcept;

} // namespace macadam
