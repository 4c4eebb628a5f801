// bench/machine.cpp - the machine, compiler and libraries of a measurement.
// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.h"

#include <fstream>
#include <sched.h>
#include <thread>

namespace obscura::bench {

namespace {

std::string cpu_name() {
    std::ifstream info("/proc/cpuinfo");
    std::string line;
    while (std::getline(info, line)) {
        const size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

/// Cores that this process may run on: fewer than the machine's in a container.
int usable_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
    return static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace

std::string compiler_name() {
#if defined(__clang__)
    return "clang " __clang_version__;
#else
    return "GCC " __VERSION__;
#endif
}

Machine describe_machine() {
    Machine machine;
    machine.cpu = cpu_name();
    machine.cores = usable_cores();
    machine.compiler = compiler_name();
    machine.build_type = OBSCURA_BUILD_TYPE;
    machine.version = OBSCURA_VERSION;
    return machine;
}

}  // namespace obscura::bench
