// stages/wavefront.h - traces a batch of paths through the stages, bounce by bounce.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "accel/ray_recording.h"
#include "stages/catcher_work.h"
#include "stages/light_path_state.h"
#include "stages/raycast_notes.h"
#include "stages/stage_seconds.h"
#include "stages/stages.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace obscura {

/// What the wavefront loop computes. To add an integrator: see render/render.h.
enum class WavefrontKind { path, ao, raycast, wireframe, aov, heat };

/// A wireframe pixel is sampled by a grid of rays, this many a side, each for its own square.
inline constexpr int wireframe_side = 4;
inline constexpr int wireframe_rays = wireframe_side * wireframe_side;

struct WavefrontCounters {
    uint64_t paths = 0;
    uint64_t camera_rays = 0;
    uint64_t bounce_rays = 0;
    uint64_t shadow_rays = 0;
    uint64_t refused_rays = 0;
    uint64_t nonfinite_samples = 0;
    StageSeconds seconds;
};

/// Length of a batch's columns: stages read and write whole registers.
inline constexpr size_t padded_batch_size = batch_size + 16;

/// The columns of one batch, reused from batch to batch. One per thread.
class Workspace {
public:
    Workspace();

    /// Resets the state that samples keep from bounce to bounce.
    void clear_slots(const SceneView& scene) {
        if (scene.thin_walls) distance_since_scattering.assign(slot_time.size(), 0.0f);
        if (scene.occludes) occlusion.assign(slot_time.size(), 1.0f);
        if (scene.passable_media) shadow_media.assign(slot_time.size(), 0U);
        if (scene.lights.tree.nodes != nullptr) lit_points.resize(slot_time.size());
    }

    /// Makes columns for AOVs, in aov_outputs.
    void allot_aovs(std::span<const Aov> aovs);

    PathColumns paths[2];
    HitColumns hits;
    HitColumns random_walk_hits;  ///< in scattering media, and of shadow rays at thin walls
    std::vector<uint32_t> random_walk_path;  ///< path index of each random walk, or of each probe
    MissColumns misses;
    ShadowColumns shadows;
    SampleColumns samples;
    std::vector<uint8_t> occluded;
    std::vector<uint8_t> thin_walls;  ///< where there are thin walls; see Accel::occluded
    std::vector<float> distance_since_scattering;  ///< likewise, by sample index; see ShadeColumns
    std::vector<float> occlusion;                  ///< where SceneView::occludes; see ShadeColumns
    std::vector<uint32_t> shadow_media;            ///< see ShadowMediaColumns, by sample index
    std::vector<LitPointRecord> lit_points;        ///< where there is a light tree, likewise
    std::vector<SharedFaces> shared_faces;         ///< where media touch, by sample index
    std::vector<float> slot_time;                  ///< where something moves; see 1_shutter.h
    std::vector<float> ray_time;                   ///< the same, by index of the rays to be asked
    std::vector<PassedBack> passed_backs;          ///< of this batch's camera rays
    std::vector<CutFaces> cut_faces;               ///< by sample index: those of passed_backs
    Cutaway cutaway;                               ///< of the rays that are asked now
    std::vector<float> splats[4];                  ///< as SplatColumns, by index
    std::vector<float> ray_end;                    ///< of paths, where there are splats
    std::vector<float> camera_length_m;  ///< how far camera rays may go; for cameras that say it
    std::vector<AovOutput> aov_outputs;  ///< of this batch, by sample index; see allot_aovs
    std::vector<uint32_t> rays_cast;     ///< by sample index, where WavefrontInput::counts_rays
    LightPathState light_paths;          ///< of this batch, where WavefrontInput::light_paths
    CatcherWork catcher;                 ///< empty unless there are shadow catchers
    std::vector<float> passed_on;        ///< by sample index: see wavefront_aov.h
    int looking_for_albedo = 0;          ///< likewise: paths that are still followed, at most

private:
    std::vector<float> aov_memory_;
    std::vector<std::byte> memory_;
};

/// The rays of paths; the caller sets their end and time.
inline RayColumns rays_of(const PathView& p, int count) {
    return {.ox = p.ox,
            .oy = p.oy,
            .oz = p.oz,
            .dx = p.dx,
            .dy = p.dy,
            .dz = p.dz,
            .tfar = nullptr,
            .key = p.path_key,
            .count = count};
}

inline RayColumns rays_of(const ShadowView& s, int count) {
    return {.ox = s.ox,
            .oy = s.oy,
            .oz = s.oz,
            .dx = s.dx,
            .dy = s.dy,
            .dz = s.dz,
            .tfar = s.tfar,
            .key = s.path_key,
            .count = count};
}

/// The shadow catchers of an image.
struct CatcherSettings {
    bool surfaces = false;          ///< some surfaces have visibility_catcher
    std::optional<float> ground_m;  ///< height of a plane that is one; it is no geometry
    float below_ground_m = 0;       ///< how far below it glass that stands on it may let rays out
    bool reflects = false;          ///< they reflect other surfaces

    bool any() const { return surfaces || ground_m.has_value(); }
};

/// The inputs of the wavefront loop.
struct WavefrontInput {
    const StageTable* stages;
    const Accel* accel;
    SceneView scene;
    BatchSettings batch;
    const Accel* counting = nullptr;  ///< for WavefrontKind::heat: see Accel::build_counting
    WavefrontKind kind = WavefrontKind::path;
    std::span<const Aov> aovs = {};               ///< written beside light, or alone by trace_aov
    const FrameView* frames = nullptr;            ///< for Aov::motion; null: nothing moves
    bool counts_rays = false;                     ///< fills Workspace::rays_cast
    const LightPathTable* light_paths = nullptr;  ///< for WavefrontKind::path: the light layers
    RayRecorder* recorder = nullptr;  ///< records every ray of this thread; null: no recording
    RaycastNotes* notes = nullptr;    ///< for a raycast of one pixel; null: no notes
    const VisibilityFlags* visibility = nullptr;  ///< null: no surface has any
    CatcherSettings catchers = {};                ///< for WavefrontKind::path
};

/// Makes batch.samples samples for `pixels` pixels (pixels * samples <= batch_size) and adds them
/// to the pixels' sums; work.aov_outputs, work.rays_cast and work.light_paths hold what was asked
/// for beside, and work.catcher what shadow catchers received. For every kind but AOVs and heat.
void trace_batch(const WavefrontInput& in,
                 int pixels,
                 Workspace& work,
                 PixelSum* sums,
                 WavefrontCounters& counters);

/// Writes one ambient occlusion ray for every hit, without tracing it.
///
/// In      work.paths[0], work.hits: `count` paths; they are overwritten
/// Out     work.shadows. Returns how many.
int spawn_ambient_rays(const WavefrontInput& in, int count, Workspace& work);

/// Pixels in a batch of AOVs: their columns fit the nearest cache.
inline constexpr int aov_batch_size = 1024;

/// Writes in.aovs at `pixels` <= batch_size pixel centres to work.samples, one entry each: their
/// channels one after the other to r, g, b and a. Or wireframe or heat, by in.kind.
void trace_aov(const WavefrontInput& in, int pixels, Workspace& work, WavefrontCounters& counters);

}  // namespace obscura
