// stages/dispatch.cpp - chooses the instruction set that the stages run on.
// SPDX-License-Identifier: Apache-2.0
#include "stages/dispatch.h"

#include "base/cpu.h"

namespace obscura {

bool has_isa(Isa isa) {
    if (isa == Isa::avx2) return cpu_has_avx2();
    if (isa == Isa::avx512) return cpu_has_avx512();
    return isa == Isa::automatic || isa == Isa::baseline;
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
