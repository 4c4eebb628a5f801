// base/cpu_quota.cpp - how many cores' time a container lets the process use.
// SPDX-License-Identifier: Apache-2.0
#include "base/cpu_quota.h"

#include "base/control_groups.h"

#include <algorithm>
#include <fstream>

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

}  // namespace

std::optional<double> cpu_quota(const Path& root) {
    std::optional<double> least;
    visit_control_groups(root, "cpu", [&](const Path& group) {
        const std::optional<double> here = quota_of(group);
        if (here) least = std::min(*here, least.value_or(*here));
    });
    return least;
}

}  // namespace obscura
