// bench/machine.cpp - the machine, compiler and libraries of a measurement.
// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sched.h>
#include <thread>

namespace obscura::bench {

namespace {

/// The first value of this name in /proc/cpuinfo; "": none.
std::string cpu_info(std::string_view name) {
    std::ifstream info("/proc/cpuinfo");
    std::string line;
    while (std::getline(info, line)) {
        const size_t colon = line.find(": ");
        if (line.starts_with(name) && colon != std::string::npos) return line.substr(colon + 2);
    }
    return {};
}

std::string cpu_name() {
    const std::string name = cpu_info("model name");
    return name.empty() ? "unknown" : name;
}

/// A line of a small file; "": there is none.
std::string line_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

const std::filesystem::path system_cpu = "/sys/devices/system/cpu/cpu0";

double clock_mhz() {
    const std::string khz = line_of(system_cpu / "cpufreq/cpuinfo_max_freq");
    if (!khz.empty()) return std::strtod(khz.c_str(), nullptr) / 1000;
    return std::strtod(cpu_info("cpu MHz").c_str(), nullptr);
}

std::vector<CpuCache> cpu_caches() {
    std::vector<CpuCache> caches;
    for (int i = 0;; ++i) {
        const auto folder = system_cpu / "cache" / ("index" + std::to_string(i));
        const std::string level = line_of(folder / "level");
        if (level.empty()) return caches;
        caches.push_back({static_cast<int>(std::strtol(level.c_str(), nullptr, 10)),
                          line_of(folder / "type"),
                          line_of(folder / "size")});
    }
}

int numa_nodes() {
    int nodes = 0;
    while (std::filesystem::exists("/sys/devices/system/node/node" + std::to_string(nodes)))
        ++nodes;
    return nodes;
}

double load_of_last_minute() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? load : -1;
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
    machine.clock_mhz = clock_mhz();
    machine.caches = cpu_caches();
    machine.numa_nodes = numa_nodes();
    machine.load = load_of_last_minute();
    machine.compiler = compiler_name();
    machine.build_type = OBSCURA_BUILD_TYPE;
    machine.version = OBSCURA_VERSION;
    return machine;
}

std::vector<std::string> doubts_about(const Machine& machine, const std::vector<int>& threads) {
    constexpr double idle_load = 0.5;  // what a system does for itself
    std::vector<std::string> doubts;
    if (machine.load > idle_load) {
        doubts.push_back(fmt::format(
            "{:.1f} threads of other programs ran here in the last minute: times will be too long "
            "and too far apart; wait until nothing else runs",
            machine.load));
    }
    const int most = threads.empty() ? 0 : *std::max_element(threads.begin(), threads.end());
    if (most > machine.cores) {
        doubts.push_back(
            fmt::format("{} threads share {} cores: they wait for one another, and of "
                        "scaling such times say nothing",
                        most,
                        machine.cores));
    }
    return doubts;
}

}  // namespace obscura::bench
