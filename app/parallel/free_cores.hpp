#pragma once

#include <cstddef>
#include <filesystem>

namespace macadam {

/// Files in which Linux states the limits of a process.
struct LimitFiles {
    std::filesystem::path own_groups = "/proc/self/cgroup";
    std::filesystem::path groups = "/sys/fs/cgroup";
    std::filesystem::path memory = "/proc/meminfo";
};

/// Number of cores that this process may use: by its affinity and by the CPU quotas of its control
/// groups, as in a container; at least 1. A part of a core counts as one.
///
/// Source: Linux, Documentation/admin-guide/cgroup-v2.rst (cpu.max) and scheduler/sched-bwc.rst
/// (cpu.cfs_quota_us of version 1).
std::size_t free_cores(const LimitFiles& files = {});

/// Number of trips that can be processed in parallel by default: one for each core, as long as each
/// has 512 MB of the free memory, the limits of control groups, and `ulimit -v`. A trip of ten
/// hours takes less than 300 MB.
std::size_t default_jobs(const LimitFiles& files = {});

} // namespace macadam
