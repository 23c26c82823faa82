#include "app/parallel/free_cores.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <sched.h>
#include <sys/resource.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_jobs = 256;

/// Returns the number of cores to which the process is bound; 1 if the system does not tell.
std::size_t cores_by_affinity() {
    constexpr int max_cores = 1 << 14;
    std::vector<cpu_set_t> cores(max_cores / CPU_SETSIZE);
    const auto bytes = cores.size() * sizeof(cpu_set_t);
    const bool is_known = ::sched_getaffinity(0, bytes, cores.data()) == 0;
    return is_known ? static_cast<std::size_t>(std::max(1, CPU_COUNT_S(bytes, cores.data()))) : 1;
}

/// Returns the numbers at the beginning of a file; empty if it does not begin with one ("max").
std::vector<double> numbers_in(const fs::path& file) {
    std::ifstream in{file};
    std::vector<double> numbers;
    for (double number = 0; numbers.size() < 2 && in >> number;) {
        numbers.push_back(number);
    }
    return numbers;
}

/// Control group of the process: a folder below the mount point of its hierarchy.
struct ControlGroup {
    fs::path mount;
    fs::path group; ///< relative to the mount point
};

/// Returns the groups of the process that may limit a resource ("cpu", "memory"): of version 2, of
/// version 1, or of both.
std::vector<ControlGroup> groups_of(const LimitFiles& files, const std::string& resource) {
    std::vector<ControlGroup> groups;
    std::ifstream in{files.own_groups};
    for (std::string line; std::getline(in, line);) { // "4:cpu,cpuacct:/path", "0::/path"
        const auto first = line.find(':');
        const auto second = first == std::string::npos ? first : line.find(':', first + 1);
        if (second == std::string::npos) {
            continue;
        }
        const auto controllers = line.substr(first + 1, second - first - 1);
        const auto group = fs::path{line.substr(second + 1)}.relative_path();
        if (controllers.empty()) {
            groups.push_back({files.groups, group});
            groups.push_back({files.groups / "unified", group});
        } else if (("," + controllers + ",").find("," + resource + ",") != std::string::npos) {
            groups.push_back({files.groups / resource, group});
            groups.push_back({files.groups / controllers, group});
        }
    }
    return groups;
}

/// Returns the lowest limit of the groups and of those above them. In a container the path of the
/// group may be that of the host; the mount point is then the group itself.
double lowest_limit(const LimitFiles& files,
                    const std::string& resource,
                    const std::function<std::optional<double>(const fs::path&)>& limit_in) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& [mount, path] : groups_of(files, resource)) {
        for (auto group = path;; group = group.parent_path()) {
            lowest = std::min(lowest, limit_in(mount / group).value_or(lowest));
            if (group.empty()) {
                break;
            }
        }
    }
    return lowest;
}

/// Returns the CPU quota of a group in cores.
std::optional<double> cpu_quota(const fs::path& group) {
    auto numbers = numbers_in(group / "cpu.max");
    if (numbers.empty()) {
        numbers = numbers_in(group / "cpu.cfs_quota_us");
        const auto period = numbers_in(group / "cpu.cfs_period_us");
        numbers.insert(numbers.end(), period.begin(), period.end());
    }
    const bool is_limited = numbers.size() == 2 && numbers[0] > 0 && numbers[1] > 0;
    return is_limited ? std::optional{numbers[0] / numbers[1]} : std::nullopt;
}

/// Returns the memory limit of a group in bytes.
std::optional<double> memory_limit(const fs::path& group) {
    for (const auto* const name : {"memory.max", "memory.limit_in_bytes"}) {
        if (const auto numbers = numbers_in(group / name); !numbers.empty() && numbers[0] > 0) {
            return numbers[0];
        }
    }
    return std::nullopt;
}

/// Returns the memory that the system can give without swapping, in bytes.
double available_memory(const fs::path& meminfo) {
    constexpr double bytes_per_kb = 1024;
    std::ifstream in{meminfo};
    for (std::string line; std::getline(in, line);) {
        std::istringstream words{line};
        std::string name;
        double kb = 0;
        if (words >> name >> kb && name == "MemAvailable:") {
            return kb * bytes_per_kb;
        }
    }
    return std::numeric_limits<double>::infinity();
}

double address_space() {
    rlimit limit{};
    const bool is_limited = ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    return is_limited ? static_cast<double>(limit.rlim_cur)
                      : std::numeric_limits<double>::infinity();
}

} // namespace

std::size_t free_cores(const LimitFiles& files) {
    const double quota = std::ceil(lowest_limit(files, "cpu", cpu_quota));
    const auto cores = static_cast<double>(cores_by_affinity());
    return static_cast<std::size_t>(std::max(1.0, std::min(cores, quota)));
}

std::size_t default_jobs(const LimitFiles& files) {
    constexpr double bytes_per_job = 512e6;
    const double memory = std::min({available_memory(files.memory),
                                    lowest_limit(files, "memory", memory_limit),
                                    address_space()});
    const double fitting = std::min(memory / bytes_per_job, static_cast<double>(max_jobs));
    return std::clamp<std::size_t>(
        static_cast<std::size_t>(fitting), 1, std::min(free_cores(files), max_jobs));
}

} // namespace macadam
