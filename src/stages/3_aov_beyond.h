// stages/3_aov_beyond.h - AOVs that look beyond the hit: what mirrors show, neighbouring frames.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_surface.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// One group of first hits, whose AOVs are written.
struct AovGroup {
    const SceneView& scene;
    const BatchSettings& batch;
    const PathLanes& path;
    const HitLanes& hit;
    int first;  ///< index of its first sample
    Mask hits;
};

/// Writes the channels of an AOV of one group; 0 where nothing was hit.
OBSCURA_INLINE void store_aov(const AovOutput& out, const AovGroup& at, const Four<Lanes>& value) {
    const Lanes lanes[] = {value.x, value.y, value.z, value.w};
    for (int c = 0; c < channel_count(out.aov); ++c)
        store(out.columns[c] + at.first, select(at.hits, lanes[c], Lanes(0.0f)));
}

OBSCURA_INLINE void store_aov(const AovOutput& out, const AovGroup& at, const Vec3<Lanes>& value) {
    store_aov(out, at, Four<Lanes>{value.x, value.y, value.z, Lanes(0.0f)});
}

constexpr bool looks_beyond(Aov aov) {
    return aov == Aov::albedo || aov == Aov::motion;
}

/// Writes one of these AOVs, whichever it is.
///
/// In      interaction, common: of the hits, by HitUse::attributes; columns: as write_aovs
void write_aov_beyond(const AovGroup& at,
                      const SurfaceInteraction& interaction,
                      const CommonTexel& common,
                      const AovColumns& columns,
                      const AovOutput& out);

}  // namespace OBSCURA_ISA
}  // namespace obscura
