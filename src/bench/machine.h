// bench/machine.h - the machine, compiler and libraries of a measurement.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/report.h"

namespace obscura::bench {

/// "GCC 12.2.0" or "clang 14.0.6".
std::string compiler_name();

/// The CPU's own name, clock, caches and NUMA nodes where the system tells them, and the load at
/// this moment; all but `embree`.
Machine describe_machine();

/// What makes times on this machine doubtful, as sentences: the CPU was busy before, more threads
/// than cores. Empty: nothing.
std::vector<std::string> doubts_about(const Machine& machine, const std::vector<int>& threads);

}  // namespace obscura::bench
