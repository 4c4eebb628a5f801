// base/memory_limit.cpp - how much memory the machine, a container or the shell allows.
// SPDX-License-Identifier: Apache-2.0
#include "base/memory_limit.h"

#include "base/control_groups.h"

#include <fstream>
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
    visit_control_groups(root, "memory", [&](const Path& group) {
        consider_file(group / "memory.max", bound);
        consider_file(group / "memory.limit_in_bytes", bound);
    });
    consider_address_space(bound);
    return bound;
}

}  // namespace obscura
