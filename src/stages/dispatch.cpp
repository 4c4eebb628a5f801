// stages/dispatch.cpp - chooses the instruction set that the stages run on.
// SPDX-License-Identifier: Apache-2.0
#include "stages/dispatch.h"

#include "base/cpu.h"

namespace obscura {

namespace {

// The build says by OBSCURA_HAS_... which instruction sets it compiled the stages for.
const StageTable* built_stages(Isa isa) {
#if defined(OBSCURA_HAS_avx512)
    if (isa == Isa::avx512 && cpu_has_avx512()) return &isa_avx512::stage_table;
#endif
#if defined(OBSCURA_HAS_avx2)
    if (isa == Isa::avx2 && cpu_has_avx2()) return &isa_avx2::stage_table;
#endif
#if defined(OBSCURA_HAS_baseline)
    if (isa == Isa::baseline) return &isa_baseline::stage_table;
#endif
    if (isa == Isa::automatic) {
        for (const Isa widest : {Isa::avx512, Isa::avx2, Isa::baseline}) {
            if (const StageTable* stages = built_stages(widest)) return stages;
        }
    }
    return nullptr;
}

}  // namespace

bool has_isa(Isa isa) {
    return built_stages(isa) != nullptr;
}

const StageTable& stage_table_for(Isa isa) {
    return *built_stages(isa);
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
