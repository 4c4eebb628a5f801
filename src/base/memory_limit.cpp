// base/memory_limit.cpp - how much memory the machine, a container or the shell allows.
// SPDX-License-Identifier: Apache-2.0
#include "base/memory_limit.h"

#include <fstream>
#include <sstream>
#include <sys/resource.h>

namespace obscura {

namespace {

using Path = std::filesystem::path;

void lower(MemoryBound& bound, uint64_t bytes, const char* source) {
    if (bytes < bound.bytes) bound = {bytes, source};
}

/// The limit in a file of a control group; "max", or no file, is none.
void consider_file(const Path& file, MemoryBound& bound) {
    uint64_t bytes = 0;
    if (std::ifstream(file) >> bytes) lower(bound, bytes, "the control group's limit");
}

/// The limits of a group and of those above it, of either version, down to the folder of a mount.
/// A container may see its own group as the mount, and still be told the group's name outside.
void consider_group(const Path& mount, const Path& group, MemoryBound& bound) {
    Path at = mount;
    const auto consider = [&] {
        consider_file(at / "memory.max", bound);
        consider_file(at / "memory.limit_in_bytes", bound);
    };
    consider();
    for (const Path& name : group.relative_path()) {
        at /= name;
        consider();
    }
}

void consider_groups(const Path& root, MemoryBound& bound) {
    const Path mounts = root / "sys/fs/cgroup";
    std::ifstream groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {  // "4:memory:/group" or "0::/group"
        std::istringstream fields(line);
        std::string number;
        std::string controllers;
        std::string group;
        std::getline(fields, number, ':');
        std::getline(fields, controllers, ':');
        std::getline(fields, group);
        if (controllers.empty()) {
            consider_group(mounts, group, bound);
            consider_group(mounts / "unified", group, bound);
        } else if (("," + controllers + ",").find(",memory,") != std::string::npos) {
            consider_group(mounts / controllers, group, bound);
            consider_group(mounts / "memory", group, bound);
        }
    }
}

/// "MemTotal: 16384 kB" is the first line of /proc/meminfo.
void consider_machine(const Path& root, MemoryBound& bound) {
    std::ifstream file(root / "proc/meminfo");
    std::string name;
    uint64_t kibibytes = 0;
    if (file >> name >> kibibytes && name == "MemTotal:" && kibibytes < UINT64_MAX >> 10)
        lower(bound, kibibytes << 10, "the machine's memory");
}

void consider_address_space(MemoryBound& bound) {
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    lower(bound, limit.rlim_cur, "the limit on the address space (ulimit -v)");
}

}  // namespace

MemoryBound memory_bound(const Path& root) {
    MemoryBound bound;
    consider_machine(root, bound);
    consider_groups(root, bound);
    consider_address_space(bound);
    return bound;
}

}  // namespace obscura
