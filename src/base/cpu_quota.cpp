// base/cpu_quota.cpp - how many cores' time a container lets the process use.
// SPDX-License-Identifier: Apache-2.0
#include "base/cpu_quota.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

namespace obscura {

namespace {

using Path = std::filesystem::path;

/// The first number of a file; 0: there is none.
double number_in(const Path& file) {
    double number = 0;
    std::ifstream(file) >> number;
    return number;
}

/// Cores' time by the files of one group, of either version; nothing: unlimited.
std::optional<double> quota_of(const Path& group) {
    double quota = 0;
    double period = 0;
    if (std::ifstream file(group / "cpu.max"); file) {
        if (!(file >> quota >> period)) return {};  // "max 100000"
    } else {
        quota = number_in(group / "cpu.cfs_quota_us");  // -1: unlimited
        period = number_in(group / "cpu.cfs_period_us");
    }
    if (quota <= 0 || period <= 0) return {};
    return quota / period;
}

/// The least quota of a group and of those above it, down to the folder of a mount. A container may
/// see its own group as the mount, and still be told the group's name outside.
std::optional<double> min_quota(const Path& mount, const Path& group) {
    std::optional<double> least = quota_of(mount);
    Path at = mount;
    for (const Path& name : group.relative_path()) {
        at /= name;
        const std::optional<double> here = quota_of(at);
        if (here) least = std::min(*here, least.value_or(*here));
    }
    return least;
}

/// Whether "cpu" is one of the controllers "cpu,cpuacct".
bool has_cpu(const std::string& controllers) {
    return ("," + controllers + ",").find(",cpu,") != std::string::npos;
}

}  // namespace

std::optional<double> cpu_quota(const Path& root) {
    const Path mounts = root / "sys/fs/cgroup";
    std::optional<double> least;
    const auto consider = [&](const Path& mount, const Path& group) {
        const std::optional<double> found = min_quota(mount, group);
        if (found) least = std::min(*found, least.value_or(*found));
    };
    std::ifstream groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {  // "1:cpu,cpuacct:/group" or "0::/group"
        std::istringstream fields(line);
        std::string number;
        std::string controllers;
        std::string group;
        std::getline(fields, number, ':');
        std::getline(fields, controllers, ':');
        std::getline(fields, group);
        if (controllers.empty()) {
            consider(mounts, group);
            consider(mounts / "unified", group);
        } else if (has_cpu(controllers)) {
            consider(mounts / controllers, group);
            consider(mounts / "cpu", group);
        }
    }
    return least;
}

}  // namespace obscura
