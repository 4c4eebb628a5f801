// stages/wavefront_shadows.h - stage 4: shadow rays through thin walls and the boundaries of media.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

/// Medium stacks of shadow rays by sample index: see ShadowMediaColumns. Null: they have none.
inline uint32_t* shadow_media(const WavefrontInput& in, Workspace& work) {
    const bool passes = in.kind == WavefrontKind::path && in.scene.passable_media;
    return passes ? work.shadow_media.data() : nullptr;
}

/// Stage 4 for the `count` shadow rays of a bounce; adds their light to the samples.
void trace_shadows(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c);

/// The same for those of random walks' scatterings. Overwrites work.random_walk_hits.
void trace_walk_shadows(const WavefrontInput& in,
                        int count,
                        const Flight& flight,
                        Workspace& work,
                        WavefrontCounters& c);

}  // namespace obscura
