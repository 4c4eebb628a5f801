// stages/walk.h - walks a batch of paths through the stages, bounce by bounce.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "accel/ray_recording.h"
#include "stages/raycast_notes.h"
#include "stages/stage_seconds.h"
#include "stages/stages.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace obscura {

/// What a walk computes. To add a quantity: stages/3_quantity.cpp; a transport: a case in walk().
enum class WalkKind { path, ao, raycast, wireframe, quantity };

/// A wireframe's pixels are looked at through a grid of so many rays, each for a square of its own.
inline constexpr int wireframe_side = 4;
inline constexpr int wireframe_rays = wireframe_side * wireframe_side;

struct WalkCounters {
    uint64_t paths = 0;
    uint64_t camera_rays = 0;
    uint64_t bounce_rays = 0;
    uint64_t shadow_rays = 0;
    uint64_t refused_rays = 0;
    uint64_t nonfinite_samples = 0;
    StageSeconds seconds;
};

/// Of the columns of a batch: stages read and write whole registers.
inline constexpr size_t padded_rows = batch_rows + 16;

/// The columns of one batch, reused from batch to batch. One per thread.
class Workspace {
public:
    Workspace();

    /// What slots keep from bounce to bounce, as it is before the first.
    void clear_slots(const SceneView& scene) {
        if (scene.thin_walls) passed.assign(slot_time.size(), 0.0f);
        if (scene.occludes) occlusion.assign(slot_time.size(), 1.0f);
    }

    PathRows paths[2];
    HitRows hits;
    HitRows walker_hits;  ///< inside bodies that scatter light, and of shadow rays at thin walls
    std::vector<uint32_t> walker_row;
    MissRows misses;
    ShadowRows shadows;
    SampleRows samples;
    std::vector<uint8_t> occluded;
    std::vector<uint8_t> walls;             ///< where there are thin walls; see Accel::occluded
    std::vector<float> passed;              ///< likewise, by slot; see ShadeRows
    std::vector<float> occlusion;           ///< where SceneView::occludes; see ShadeRows
    std::vector<SharedFaces> shared_faces;  ///< where bodies touch, by slot
    std::vector<float> slot_time;           ///< where something moves; see 1_shutter.h
    std::vector<float> ray_time;            ///< the same, by row of the rays to be asked
    std::vector<PassedBack> passed_backs;   ///< of this batch's camera rays
    std::vector<CutFaces> cut_faces;        ///< the same by slot, else nothing
    Cutaway cutaway;                        ///< of the rays that are asked now
    std::vector<float> splats[4];           ///< as SplatColumns, by row
    std::vector<float> ray_end;             ///< of paths, where there are splats
    std::vector<float> camera_length_m;     ///< how far camera rays may go; for cameras that say it

private:
    std::vector<std::byte> memory_;
};

/// The rays of paths; their end and time are for the caller to set.
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

/// Everything a walk reads.
struct WalkInput {
    const StageTable* stages;
    const Accel* accel;
    SceneView scene;
    BatchSettings batch;
    const Accel* counting = nullptr;  ///< for Quantity::heat: see Accel::build_counting
    WalkKind kind = WalkKind::path;
    Quantity quantity = Quantity::normal;  ///< of walk_quantity
    RayRecorder* recorder = nullptr;       ///< keeps every ray; of this thread alone; null: nobody
    RaycastNotes* notes = nullptr;         ///< of a raycast of one pixel; null: nobody
};

/// Makes batch.samples samples for `pixels` pixels (pixels * samples <= batch_rows) and adds them
/// to the pixels' sums. For every kind but quantity.
void walk(const WalkInput& in, int pixels, Workspace& work, PixelSum* sums, WalkCounters& counters);

/// Starts one ray at every hit, as ambient occlusion does, and leaves it at that.
///
/// In      work.paths[0], work.hits: `count` rows; they are overwritten
/// Out     work.shadows. Returns how many.
int spawn_ambient_rays(const WalkInput& in, int count, Workspace& work);

/// Rows of a batch of quantities: they stay in the nearest cache.
inline constexpr int quantity_rows = 1024;

/// Finds in.quantity at `pixels` <= batch_rows pixel centres; work.samples has one row for each.
void walk_quantity(const WalkInput& in, int pixels, Workspace& work, WalkCounters& counters);

}  // namespace obscura
