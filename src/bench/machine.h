// bench/machine.h - the machine, compiler and libraries of a measurement.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/report.h"

namespace obscura::bench {

/// "GCC 12.2.0" or "clang 14.0.6".
std::string compiler_name();

/// The CPU's own name where the system tells it; all but `embree`.
Machine describe_machine();

}  // namespace obscura::bench
