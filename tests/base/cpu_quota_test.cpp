// tests/base/cpu_quota_test.cpp - quotas of control groups, as Linux and containers lay them out.
// SPDX-License-Identifier: Apache-2.0
#include "base/cpu_quota.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"

namespace obscura {
namespace {

/// A folder that stands for the root of a machine.
struct Machine {
    TempFolder root;

    void write(const std::string& file, const std::string& text) const {
        std::filesystem::create_directories((root / file).parent_path());
        root.write(file, text);
    }
};

TEST(CpuQuota, TheLeastOfAllGroupsAboveCounts) {
    const Machine machine;
    machine.write("proc/self/cgroup", "0::/pods/burst/job\n");
    EXPECT_FALSE(cpu_quota(machine.root.path())) << "no group has a quota";
    machine.write("sys/fs/cgroup/pods/cpu.max", "800000 100000\n");
    EXPECT_EQ(cpu_quota(machine.root.path()), 8);
    machine.write("sys/fs/cgroup/pods/burst/cpu.max", "250000 100000\n");
    machine.write("sys/fs/cgroup/pods/burst/job/cpu.max", "max 100000\n");
    EXPECT_EQ(cpu_quota(machine.root.path()), 2.5);
}

TEST(CpuQuota, AContainerSeesItsGroupAsTheMount) {
    const Machine machine;
    machine.write("proc/self/cgroup", "0::/\n");
    machine.write("sys/fs/cgroup/cpu.max", "50000 100000\n");
    EXPECT_EQ(cpu_quota(machine.root.path()), 0.5);
    machine.write("proc/self/cgroup", "0::/a/name/outside\n");
    EXPECT_EQ(cpu_quota(machine.root.path()), 0.5);
}

TEST(CpuQuota, VersionOneHasMicroseconds) {
    const Machine machine;
    machine.write("proc/self/cgroup", "5:memory:/m\n4:cpu,cpuacct:/jobs\n3:cpuset:/s\n");
    machine.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
    machine.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    EXPECT_FALSE(cpu_quota(machine.root.path()));
    machine.write("sys/fs/cgroup/cpu,cpuacct/jobs/cpu.cfs_quota_us", "300000\n");
    machine.write("sys/fs/cgroup/cpu,cpuacct/jobs/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(cpu_quota(machine.root.path()), 3);
}

TEST(CpuQuota, OtherSystemsAndOddFilesHaveNone) {
    const Machine machine;
    EXPECT_FALSE(cpu_quota(machine.root.path()));
    machine.write("proc/self/cgroup", "\n:\nnonsense\n0::/../up\n1:cpu\n");
    machine.write("sys/fs/cgroup/cpu.max", "0 0\n");
    machine.write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "many\n");
    EXPECT_FALSE(cpu_quota(machine.root.path()));
}

}  // namespace
}  // namespace obscura
