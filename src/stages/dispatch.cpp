// stages/dispatch.cpp - picks the instruction set that the stages run on.
// SPDX-License-Identifier: Apache-2.0
#include "stages/dispatch.h"

namespace obscura {

bool has_isa(Isa isa) {
#if defined(__x86_64__)
    // Feature by feature: clang 14 does not know the names of the x86-64 levels.
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
    if (isa == Isa::avx2) return v3;
    if (isa == Isa::avx512) return v4;
    return true;
#else
    return isa == Isa::automatic || isa == Isa::baseline;
#endif
}

const StageTable& stage_table_for(Isa isa) {
#if defined(__x86_64__)
    if (isa == Isa::avx512 || (isa == Isa::automatic && has_isa(Isa::avx512))) {
        return isa_avx512::stage_table;
    }
    if (isa == Isa::avx2 || (isa == Isa::automatic && has_isa(Isa::avx2))) {
        return isa_avx2::stage_table;
    }
#endif
    (void)isa;
    return isa_baseline::stage_table;
}

const char* embree_isa_for(Isa isa) {
    switch (isa) {
        case Isa::baseline:
            return "sse4.2";
        case Isa::avx2:
            return "avx2";
        case Isa::avx512:
            return "avx512";
        case Isa::automatic:
            break;
    }
    return "";
}

}  // namespace obscura
