// stages/3_aov_beyond.cpp - AOVs that look beyond the hit: what mirrors show, neighbouring frames.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_aov_beyond.h"

#include "stages/3_albedo.h"
#include "stages/3_frame_motion.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Writes the albedo of the hits, or that a later hit will tell it.
void store_albedo(const AovGroup& at,
                  const SurfaceInteraction& interaction,
                  const CommonTexel& common,
                  float* passed_on,
                  const AovOutput& out) {
    PathLanes path = at.path;
    path.medium_stack = LanesU(at.batch.medium_stack);  // rays of pixel centres have none
    HitAlbedo albedo = albedo_at(at.scene, at.hit, path, interaction, common);
    if (passed_on != nullptr) {
        store(passed_on + at.first, select(at.hits & albedo.passed_on, Lanes(1.0f), Lanes(0.0f)));
        albedo.color = select(albedo.passed_on, splat3(Lanes(0.0f)), albedo.color);
    }
    store_aov(out, at, albedo.color);
}

void store_motion(const AovGroup& at,
                  const Vec3<Lanes>& position,
                  const FrameView* frames,
                  const AovOutput& out) {
    Four<Lanes> pixels{Lanes(0.0f), Lanes(0.0f), Lanes(0.0f), Lanes(0.0f)};
    if (frames != nullptr) {
        pixels = frame_motion({at.scene, at.batch, *frames, at.hit, at.hits}, position);
    }
    store_aov(out, at, pixels);
}

}  // namespace

void write_aov_beyond(const AovGroup& at,
                      const SurfaceInteraction& interaction,
                      const CommonTexel& common,
                      const AovColumns& columns,
                      const AovOutput& out) {
    if (out.aov == Aov::albedo) store_albedo(at, interaction, common, columns.passed_on, out);
    if (out.aov == Aov::motion) store_motion(at, interaction.g.position, columns.frames, out);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
