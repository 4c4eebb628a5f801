// stages/3_aov_beyond.h - AOVs that look beyond the hit: what mirrors show, neighbouring frames.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

constexpr bool looks_beyond(Aov aov) {
    return aov == Aov::albedo || aov == Aov::motion;
}

/// Writes those AOVs, as write_aovs does the others.
void write_aovs_beyond(const SceneView& scene,
                       const BatchSettings& batch,
                       int count,
                       const AovColumns& columns);

}  // namespace OBSCURA_ISA
}  // namespace obscura
