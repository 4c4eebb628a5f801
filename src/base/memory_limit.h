// base/memory_limit.h - how much memory the machine, a container or the shell lets the process use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace obscura {

/// A bound on this process's memory, and who sets it.
struct MemoryBound {
    uint64_t bytes = UINT64_MAX;  ///< UINT64_MAX: none is known
    std::string source = "no known limit";
};

/// A number of bytes, or a share of what the process may have.
struct MemorySize {
    uint64_t bytes = 0;  ///< unless there is a share
    double percent = 0;  ///< 0: `bytes` count
};

/// The least of the limits of the process's control group and those above it, the limit on its
/// address space (RLIMIT_AS), and the machine's memory.
///
/// In      root: where /proc and /sys are
/// Source  Linux, Documentation/admin-guide/cgroup-v2.rst, memory.max; cgroup-v1/memory.rst,
///         memory.limit_in_bytes; proc(5), meminfo
MemoryBound memory_bound(const std::filesystem::path& root = "/");

/// Bytes of addresses that the process may still take under the limit on its address space
/// (RLIMIT_AS); UINT64_MAX: there is none, or the system does not tell.
///
/// Source  proc(5), statm
uint64_t address_space_left();

/// Lets all threads share one arena of malloc where the address space is limited: each takes 64 MiB
/// of addresses for one of its own, otherwise. Only for programs that own their process.
///
/// Source  mallopt(3), M_ARENA_MAX
void spare_addresses();

/// Lets freed memory go back to the system, also the blocks of some megabytes that malloc otherwise
/// learns to keep, up to 64 MiB in the arena of each thread. For programs that run for days.
///
/// Source  mallopt(3), "dynamic mmap threshold"
void give_back_freed_memory();

/// Refuses what would find too few addresses: libraries that start threads end the process without
/// a word where these can have no stacks.
///
/// In      left: of address_space_left; purpose: "rendering"
/// Errors  33 E-MEM
Result<void> check_address_space(uint64_t left, uint64_t needed, const std::string& purpose);

}  // namespace obscura
