// stages/dispatch.h - chooses the instruction set that the stages run on.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {

// This header is for files compiled as baseline only: there, isa_baseline is the inline namespace.
inline namespace isa_baseline {
extern const StageTable stage_table;
}
namespace isa_avx2 {
extern const StageTable stage_table;
}
namespace isa_avx512 {
extern const StageTable stage_table;
}

/// Which lanes the stages run on.
enum class Isa { automatic, baseline, avx2, avx512 };

/// True when this build (OBSCURA_ISAS) and this CPU have it; automatic: when they share any.
bool has_isa(Isa isa);

/// The stages for `isa`; automatic takes the widest that has_isa. has_isa(isa) must hold.
const StageTable& stage_table_for(Isa isa);

/// The isa that Embree is restricted to, so that results do not depend on the CPU; "": Embree's
/// own choice.
const char* embree_isa_for(Isa isa);

}  // namespace obscura
