#include "app/parallel/free_cores.hpp"

#include "support/program/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

/// System with these groups of the process and no limits.
LimitFiles system_with(const std::string& own_groups) {
    const auto folder = fresh_folder();
    write_file(folder / "own", own_groups);
    write_file(folder / "meminfo", "MemTotal: 99000000 kB\nMemAvailable: 90000000 kB\n");
    return {
        .own_groups = folder / "own", .groups = folder / "groups", .memory = folder / "meminfo"};
}

void limit(const LimitFiles& files, const fs::path& name, const std::string& text) {
    fs::create_directories((files.groups / name).parent_path());
    write_file(files.groups / name, text + "\n");
}

TEST(FreeCores, AreThoseOfTheAffinityWithoutAQuota) {
    const auto files = system_with("0::/user\n");
    const auto all = free_cores(files);
    EXPECT_GE(all, 1U);
    limit(files, "user/cpu.max", "max 100000");
    EXPECT_EQ(free_cores(files), all);
}

TEST(FreeCores, FollowTheQuotaOfAGroupAndOfThoseAboveIt) {
    const auto files = system_with("0::/machine/job\n");
    limit(files, "machine/job/cpu.max", "6400000 100000");
    limit(files, "machine/cpu.max", "50000 100000");
    EXPECT_EQ(free_cores(files), 1U);
}

TEST(FreeCores, CountAPartOfACoreAsOne) {
    const auto files = system_with("0::/\n");
    const auto all = free_cores(files);
    limit(files, "cpu.max", "150000 100000");
    EXPECT_EQ(free_cores(files), std::min<std::size_t>(all, 2));
}

TEST(FreeCores, FollowTheQuotaOfVersion1AtTheMountOfAContainer) {
    const auto files = system_with("4:cpu,cpuacct:/docker/0123\n3:memory:/docker/0123\n");
    limit(files, "cpu,cpuacct/cpu.cfs_quota_us", "100000");
    limit(files, "cpu,cpuacct/cpu.cfs_period_us", "100000");
    EXPECT_EQ(free_cores(files), 1U);
}

TEST(FreeCores, IgnoreFilesThatAreDamagedOrMissing) {
    const auto files = system_with("nonsense\n::\n0::/../../etc\n");
    limit(files, "cpu.max", "-1 0");
    EXPECT_EQ(free_cores(files), free_cores({.own_groups = "/nowhere", .groups = "/nowhere"}));
}

TEST(DefaultJobs, AreFewerIfTheMemoryIsSmall) {
    const auto files = system_with("0::/\n");
    limit(files, "memory.max", "600000000");
    EXPECT_EQ(default_jobs(files), 1U);
    limit(files, "memory.max", "1000");
    EXPECT_EQ(default_jobs(files), 1U);
    write_file(files.memory, "MemAvailable: 100 kB\n");
    EXPECT_EQ(default_jobs(files), 1U);
}

} // namespace
} // namespace macadam::testing
