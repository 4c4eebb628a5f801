// stages/stages.h - the numeric stages as one table of functions per instruction set.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/doors.h"
#include "stages/pixel_sum.h"

namespace obscura {

/// What integrators that are named after a quantity write.
enum class Quantity : int {
    normal,
    facing,
    depth,
    distance,
    uv,
    albedo,
    id,
    wireframe,
    heat,  ///< not a stage's work: accel/ counts
};

/// What shade writes besides the samples.
struct ShadeCounts {
    int next = 0;    ///< rows in the next paths
    int shadow = 0;  ///< rows in the shadow rays
};

/// Hits and lights that one step of ray casting joins.
struct RaycastRange {
    int first_hit = 0, hits = 0;      ///< first_hit: a multiple of 16
    int first_light = 0, lights = 0;  ///< punctual ones first, then RaycastView::centres
};

/// The columns that shading one bounce touches.
struct ShadeRows {
    PathRows paths;      ///< in: this bounce's rays; they are overwritten (packed in place)
    HitRows hits;        ///< in: what they hit; overwritten likewise
    MissRows misses;     ///< scratch
    PathRows next;       ///< out
    ShadowRows shadows;  ///< out
    SampleRows samples;  ///< in and out
    const float* time = nullptr;  ///< by slot; null: nothing moves
    float* passed = nullptr;      ///< where SceneView::thin_walls, by slot; see stages/3_walls.h
    float* occlusion = nullptr;   ///< where SceneView::occludes, by slot; see stages/3_occlusion.h
    const SharedFaces* shared = nullptr;  ///< where SceneView::touching_bodies, by slot
};

/// The columns that ray casting reads and writes, once hits and misses are parted.
struct RaycastColumns {
    PathView paths;
    HitView hits;
    ShadowRows shadows;           ///< out
    SampleRows samples;           ///< in and out
    const float* time = nullptr;  ///< as in ShadeRows
    const SharedFaces* shared = nullptr;
};

/// The columns from which an AOV is written: row i is pixel i.
struct AovColumns {
    PathView paths;
    HitView hits;
    SampleRows samples;           ///< out
    const float* time = nullptr;  ///< by pixel; null: nothing moves
};

/// Smooth thin walls that a shadow ray passes at most, and a path after its last bounce: behind
/// more of them there is less light than should be.
inline constexpr int most_walls = 32;

/// In place of 0 and 1 in `occluded`: nothing but what may be thin walls is in the way.
inline constexpr uint8_t waits_at_wall = 2;

/// Shadow rays on their way through thin walls.
struct WallRows {
    ShadowRows shadows;  ///< in and out, packed in place
    HitView hits;
    SampleRows samples;           ///< in and out
    const float* time = nullptr;  ///< by slot; null: nothing moves
};

/// One step on that way.
struct WallStep {
    uint32_t segment = 0;
    uint32_t number = 0;
    bool random = true;  ///< texels are drawn; else filtered
};

/// Paths that begin their way through bodies that scatter light.
struct ScatterStart {
    PathView paths;       ///< all paths of a bounce
    HitView hits;         ///< what they hit
    PathRows walkers;     ///< out: those of them inside such bodies, packed
    HitRows walker_hits;  ///< out: what these hit
    uint32_t* row;        ///< out: of a walker, in `paths`
};

/// Paths on that way.
struct ScatterRows {
    PathRows paths;       ///< out, by row: walkers that are done
    HitRows hits;         ///< out: what they hit
    PathRows walkers;     ///< in and out, packed in place
    HitView walker_hits;  ///< what these hit
    uint32_t* row;        ///< in and out: of a walker, in `paths`
};

/// Paths that may have met faces of several bodies at once, and the rays that look for them: along
/// the normal through the hit, from its viewer's side.
struct ProbeRows {
    PathView paths;
    HitView hits;                 ///< what they hit
    const float* time = nullptr;  ///< by slot; null: nothing moves
    const SharedFaces* shared =
        nullptr;  ///< by slot: only those that say so are looked at; or null
    /// Out, packed. Their colours: how far along the hit lies; how far before the hit, along the
    /// normal, the path began; the distance at which rays start clear of the hit.
    ShadowRows probes;
    uint32_t* row;  ///< out: of a probe, in `paths`; and seen_from_front
};

// Distances around a hit are counted in clearances: HitGeometry::offset, at which rays start clear
// of the face that they leave, for Embree and shading round what lies nearer.

/// Faces that are nearer to each other are in the same place: a ray that starts clear of one of
/// them would miss the other.
inline constexpr float company_distance = 2.0f;

/// How far beyond a hit faces are looked for, each next one in company with the last.
inline constexpr float probe_distance = 10.0f;

/// In ProbeRows::row: the path comes from the front of what it hit.
inline constexpr uint32_t seen_from_front = 1U << 31;

/// One flight between two scatterings.
struct Flight {
    int bounce = 0;
    int number = 0;  ///< since the last surface
    bool last = false;
};

/// One instruction set's stages. To add a stage: declare it here, define it in its own numbered
/// file, list it in isa_entry.cpp and call it from walk.cpp.
struct StageTable {
    const char* isa;
    int lanes;

    /// Stage 1: one camera ray a slot; samples are cleared.
    void (*camera)(
        const BatchSettings&, int count, const PathRows&, const SampleRows&, float* length_m);

    /// Stage 1 for quantities: one ray a pixel, and of its row only what they need.
    void (*centre_camera)(const BatchSettings&, int count, const PathRows&, float* length_m);

    /// Stage 1, where something moves: the time of every slot.
    void (*open_shutter)(
        const SceneView&, bool through_centres, int count, const PathRows&, float* time);

    /// Stage 2, inside bodies that scatter light: which paths are, then one flight of each.
    int (*begin_scatter)(const SceneView&, int count, const ScatterStart&);
    int (*scatter)(const SceneView&, const Flight&, int count, const ScatterRows&);

    /// Stage 2, where bodies touch: rays that look for faces in the same place. Returns how many.
    int (*make_probes)(const SceneView&, int count, const ProbeRows&);

    /// Stage 3: hits become radiance, shadow rays and next rays; misses see the environment.
    ShadeCounts (*shade)(
        const SceneView&, const BatchSettings&, int bounce, int count, const ShadeRows&);

    /// Stage 3 for --integrator ao: one occlusion ray a hit.
    int (*shade_ao)(const SceneView&, const BatchSettings&, int count, const ShadeRows&);

    /// Stage 3 for --integrator raycast: the number of hits, which come to the front; then their
    /// shadow rays, range by range.
    int (*begin_raycast)(const SceneView&, const BatchSettings&, int count, const ShadeRows&);
    int (*shade_raycast)(const SceneView&, const RaycastRange&, const RaycastColumns&);

    /// Stage 3 for quantities: every sample is written, without light; 0 where nothing was hit.
    void (*quantity)(
        const SceneView&, const BatchSettings&, Quantity, int count, const AovColumns&);

    /// Stage 4, where there are thin walls: the rays that wait there, then one step of each.
    int (*take_waiting)(int count, const uint8_t* occluded, const ShadowRows&);
    int (*cross_walls)(const SceneView&, const WallStep&, int count, const WallRows&);

    /// Stage 5a: unoccluded shadow rows are added to their samples.
    void (*add_shadows)(int count, const ShadowView&, const uint8_t* occluded, const SampleRows&);

    /// Stage 5b: adds each pixel's samples to its sum, in sample order.
    uint64_t (*accumulate)(int pixels, const SampleRange&, const SampleRows&, PixelSum* sums);

    /// Stage 5 for quantities, whose samples are pixels: clears those that are not finite, and says
    /// how many they were.
    uint64_t (*clear_nonfinite)(int count, const SampleRows&);
};

}  // namespace obscura
