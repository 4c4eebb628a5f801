// stages/3_aov_beyond.cpp - AOVs that look beyond the hit: what mirrors show, neighbouring frames.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_albedo.h"
#include "stages/3_frame_motion.h"
#include "stages/3_shade.h"
#include "stages/3_surface.h"

#include <algorithm>
#include <array>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

constexpr bool looks_beyond(Aov aov) {
    return aov == Aov::albedo || aov == Aov::motion;
}

/// One group of hits.
struct BeyondGroup {
    const SceneView& scene;
    const BatchSettings& batch;
    const PathLanes& path;
    const HitLanes& hit;
    int first;  ///< index of its first sample
    Mask hits;
};

/// Writes the albedo of the hits, or that a later hit will tell it.
OBSCURA_INLINE void store_albedo(const BeyondGroup& at,
                                 const SurfaceInteraction& interaction,
                                 float* passed_on,
                                 const AovOutput& out) {
    PathLanes path = at.path;
    path.medium_stack = LanesU(at.batch.medium_stack);  // rays of pixel centres have none
    HitAlbedo albedo = albedo_at(at.scene, at.hit, path, interaction);
    if (passed_on != nullptr) {
        store(passed_on + at.first, select(at.hits & albedo.passed_on, Lanes(1.0f), Lanes(0.0f)));
        albedo.color = select(albedo.passed_on, splat3(Lanes(0.0f)), albedo.color);
    }
    const Lanes lanes[] = {albedo.color.x, albedo.color.y, albedo.color.z};
    for (int c = 0; c < channel_count(out.aov); ++c)
        store(out.columns[c] + at.first, select(at.hits, lanes[c], Lanes(0.0f)));
}

OBSCURA_INLINE void store_motion(const BeyondGroup& at,
                                 const Vec3<Lanes>& position,
                                 const FrameView* frames,
                                 const AovOutput& out) {
    Four<Lanes> pixels{Lanes(0.0f), Lanes(0.0f), Lanes(0.0f), Lanes(0.0f)};
    if (frames != nullptr) {
        pixels = frame_motion({at.scene, at.batch, *frames, at.hit, at.hits}, position);
    }
    const Lanes lanes[] = {pixels.x, pixels.y, pixels.z, pixels.w};
    for (int c = 0; c < channel_count(out.aov); ++c)
        store(out.columns[c] + at.first, select(at.hits, lanes[c], Lanes(0.0f)));
}

/// Writes 0 for the group that starts at index i, without hits.
OBSCURA_INLINE void store_nothing(const AovColumns& columns, int i) {
    for (const AovOutput& out : columns.outputs) {
        for (int c = 0; c < channel_count(out.aov); ++c)
            store(out.columns[c] + i, Lanes(0.0f));
    }
    if (columns.passed_on != nullptr) store(columns.passed_on + i, Lanes(0.0f));
}

void write_aovs_beyond(const SceneView& scene,
                       const BatchSettings& batch,
                       int count,
                       const AovColumns& columns) {
    for (int i = 0; i < count; i += lane_count) {
        const Mask hits =
            lanes_in_range(i, count) & (load(columns.hits.primitive + i) >= LanesI(0));
        if (none(hits)) {
            store_nothing(columns, i);
            continue;
        }
        HitLanes hit = hits_or_first(columns.hits, i, hits);
        if (columns.time != nullptr) hit.time = load(columns.time + i);  // path i is sample i
        const PathLanes path = load_paths(columns.paths, i);
        const BeyondGroup group{scene, batch, path, hit, i, hits};
        const SurfaceInteraction interaction = find_surface_interaction<HitUse::attributes>(
            scene, hit, path, {Filtering::bilinear, splat3(Lanes(0.5f)), batch.footprint_fraction});
        for (const AovOutput& out : columns.outputs) {
            if (out.aov == Aov::albedo) store_albedo(group, interaction, columns.passed_on, out);
            if (out.aov == Aov::motion)
                store_motion(group, interaction.g.position, columns.frames, out);
        }
    }
}

}  // namespace

void write_aovs(const SceneView& scene,
                const BatchSettings& batch,
                int count,
                const AovColumns& columns) {
    std::array<AovOutput, aov_entries.size()> outputs;
    const auto beyond =
        std::partition_copy(columns.outputs.begin(),
                            columns.outputs.end(),
                            outputs.begin(),
                            outputs.rbegin(),
                            [](const AovOutput& o) { return !looks_beyond(o.aov); });
    AovColumns part = columns;
    part.outputs = {outputs.begin(), beyond.first};
    if (!part.outputs.empty()) write_hit_aovs(scene, batch, count, part);
    part.outputs = {beyond.second.base(), outputs.end()};
    if (!part.outputs.empty()) write_aovs_beyond(scene, batch, count, part);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
