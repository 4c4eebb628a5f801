// base/memory_limit.cpp - how much memory the machine, a container or the shell allows.
// SPDX-License-Identifier: Apache-2.0
#include "base/memory_limit.h"

#include "base/control_groups.h"
#include "base/memory_budget.h"

#include <algorithm>
#include <fstream>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

namespace obscura {

namespace {

constexpr const char* limit_of_addresses = "the limit on the address space (ulimit -v)";

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

/// UINT64_MAX: none.
uint64_t address_space_limit() {
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return UINT64_MAX;
    return limit.rlim_cur;
}

}  // namespace

MemoryBound memory_bound(const Path& root) {
    MemoryBound bound;
    consider_machine(root, bound);
    visit_control_groups(root, "memory", [&](const Path& group) {
        consider_file(group / "memory.max", bound);
        consider_file(group / "memory.limit_in_bytes", bound);
    });
    lower(bound, address_space_limit(), limit_of_addresses);
    return bound;
}

uint64_t address_space_left() {
    const uint64_t limit = address_space_limit();
    uint64_t pages = 0;
    if (limit == UINT64_MAX || !(std::ifstream("/proc/self/statm") >> pages)) return UINT64_MAX;
    const uint64_t taken = pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
    return limit - std::min(limit, taken);
}

void spare_addresses() {
    if (address_space_limit() != UINT64_MAX) mallopt(M_ARENA_MAX, 1);
}

void give_back_freed_memory() {
    constexpr int kept = 1 << 20;
    constexpr int arenas = 4;
    mallopt(M_MMAP_THRESHOLD, kept);
    mallopt(M_TRIM_THRESHOLD, kept);
    if (address_space_limit() == UINT64_MAX) mallopt(M_ARENA_MAX, arenas);
}

Result<void> check_address_space(uint64_t left, uint64_t needed, const std::string& purpose) {
    if (left >= needed) return {};
    return fail(ExitCode::out_of_memory,
                "E-MEM",
                limit_of_addresses,
                "it leaves " + memory_text(left) + " beside what the program has taken; " +
                    purpose + " needs " + memory_text(needed));
}

}  // namespace obscura
