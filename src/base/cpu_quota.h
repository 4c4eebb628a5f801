// base/cpu_quota.h - how many cores' time a container lets the process use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace obscura {

/// The CPU time in each second of time that Linux's control groups allow the process: the least of
/// the quotas of its group and of those above it. More threads than that would stand still for the
/// rest of each period. Nothing: no quota, or another system.
///
/// In      root: where /proc and /sys are
/// Source  Linux, Documentation/admin-guide/cgroup-v2.rst, cpu.max; scheduler/sched-bwc.rst for v1
std::optional<double> cpu_quota(const std::filesystem::path& root = "/");

}  // namespace obscura
