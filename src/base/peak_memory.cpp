// base/peak_memory.cpp - the peak memory of this process.
// SPDX-License-Identifier: Apache-2.0
#include "base/peak_memory.h"

#include <cstdio>
#include <sys/resource.h>

namespace obscura {

size_t peak_memory_bytes() {
    rusage usage = {};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

bool reset_peak_memory() {
    // "5" resets the peak resident size: Linux, Documentation/filesystems/proc.rst.
    std::FILE* file = std::fopen("/proc/self/clear_refs", "w");
    if (file == nullptr) return false;
    const bool written = std::fputs("5", file) >= 0;
    return std::fclose(file) == 0 && written;
}

}  // namespace obscura
