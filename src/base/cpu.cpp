// base/cpu.cpp - detects the processor's instruction sets.
// SPDX-License-Identifier: Apache-2.0
#include "base/cpu.h"

namespace obscura {

#if defined(__x86_64__)

bool cpu_has_sse42() {
    return __builtin_cpu_supports("sse4.2");
}

bool cpu_has_avx() {
    return __builtin_cpu_supports("avx");
}

// Feature by feature: clang 14 does not know the names of the x86-64 levels.
bool cpu_has_avx2() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}

bool cpu_has_avx512() {
    return cpu_has_avx2() && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

#else

bool cpu_has_sse42() {
    return false;
}

bool cpu_has_avx() {
    return false;
}

bool cpu_has_avx2() {
    return false;
}

bool cpu_has_avx512() {
    return false;
}

#endif

}  // namespace obscura
