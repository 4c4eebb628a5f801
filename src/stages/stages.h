// stages/stages.h - the numeric stages as one table of functions per instruction set.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/aov.h"
#include "stages/path_state.h"
#include "stages/pixel_sum.h"

#include <span>

namespace obscura {

struct LightPathColumns;

/// Sizes of the columns that shade writes.
struct ShadeCounts {
    int next = 0;    ///< in the next paths
    int shadow = 0;  ///< in the shadow rays
};

/// Where a path scattered last, as the light tree takes it. By sample index.
struct LitPointRecord {
    float position[4] = {0, 0, 0, 0};  ///< where rays to lights start; the last word is unused
    float normal[4] = {0, 0, 0, 0};    ///< see LitPoint; likewise
};

/// The hits and lights that one step of ray casting pairs.
struct RaycastRange {
    int first_hit = 0, hits = 0;      ///< first_hit: a multiple of 16
    int first_light = 0, lights = 0;  ///< punctual ones first, then RaycastView::centres
};

/// The columns that shading one bounce reads and writes.
struct ShadeColumns {
    PathColumns paths;      ///< in: this bounce's rays; they are overwritten (packed in place)
    HitColumns hits;        ///< in: what they hit; overwritten likewise
    MissColumns misses;     ///< scratch
    PathColumns next;       ///< out
    ShadowColumns shadows;  ///< out
    SampleColumns samples;  ///< in and out
    const float* time = nullptr;                 ///< by sample index; null: nothing moves
    float* distance_since_scattering = nullptr;  ///< metres, by sample index; see 3_thin_walls.h
    float* occlusion = nullptr;  ///< by sample index, where SceneView::occludes: 3_occlusion.h
    const SharedFaces* shared = nullptr;  ///< by sample index, where SceneView::touching_media
    const LightPathColumns* light_paths = nullptr;  ///< null: no light layers are asked for
    uint32_t* shadow_media = nullptr;      ///< out, by sample index: see ShadowMediaColumns
    LitPointRecord* lit_points = nullptr;  ///< by sample index; null: there is no light tree
};

/// The columns that ray casting reads and writes, once hits and misses are separated.
struct RaycastColumns {
    PathView paths;
    HitView hits;
    ShadowColumns shadows;        ///< out
    SampleColumns samples;        ///< in and out
    const float* time = nullptr;  ///< as in ShadeColumns
    const SharedFaces* shared = nullptr;
};

/// An AOV and the columns that it is written to, as many as it has channels. A cache line each.
struct alignas(64) AovOutput {
    Aov aov;
    float* columns[max_aov_channels];
};

struct FrameVertices;

/// The scene one frame before an image's time, at it and one frame after it: see
/// scene/frame_motion.h.
struct FrameView {
    const float* positions = nullptr;         ///< null: no vertex moves
    const FrameVertices* vertices = nullptr;  ///< by primitive
    const Affinef* instances = nullptr;       ///< null: no instance moves
    const int32_t* instance = nullptr;  ///< by instance: the first of three; -1: it stands still
    Camera cameras[3];
    Affined camera_from_world[3];
    bool camera_moves = false;
};

/// Camera rays and what they hit, before shading: path i is sample i.
struct AovColumns {
    PathView paths;
    HitView hits;
    const float* time = nullptr;  ///< by sample index; null: nothing moves
    std::span<const AovOutput> outputs;
    /// Out, by sample index: 1 where mirrors or glass pass the albedo on to the path's next hit,
    /// and the sample is 0; null: every hit tells its own.
    float* passed_on = nullptr;
    const FrameView* frames = nullptr;  ///< null: nothing moves from frame to frame
};

/// The paths of a later bounce, before shading, of which some look for their albedo.
struct AlbedoColumns {
    PathView paths;
    HitView hits;
    const float* time = nullptr;          ///< by sample index; null: nothing moves
    const SharedFaces* shared = nullptr;  ///< by sample index, where SceneView::touching_media
    PathColumns followed_paths;           ///< scratch
    HitColumns followed_hits;             ///< scratch
    float* passed_on;                     ///< in and out: as in AovColumns
    AovOutput albedo;                     ///< in and out, by sample index
};

/// The columns of the wireframe: index i is pixel i.
struct WireframeColumns {
    PathView paths;
    HitView hits;
    SampleColumns samples;        ///< out
    const float* time = nullptr;  ///< by pixel; null: nothing moves
};

/// Maximum number of smooth thin walls that a shadow ray passes, or a path after its last bounce.
/// What lies behind more of them is too dark.
inline constexpr int max_thin_walls = 32;

/// A third value in `occluded`, beside 0 and 1: only possible thin walls are in the way.
inline constexpr uint8_t waits_at_thin_wall = 2;

/// Transparent shadow rays, which pass thin walls.
struct ThinWallColumns {
    ShadowColumns shadows;  ///< in and out, packed in place
    HitView hits;
    SampleColumns samples;             ///< in and out
    const float* time = nullptr;       ///< by sample index; null: nothing moves
    uint32_t* shadow_media = nullptr;  ///< in and out: see ShadowMediaColumns
};

/// Shadow rays on their way through media. Where SceneView::passable_media, they have a medium
/// stack each (stages/3_media.h) and are attenuated from one boundary to the next. Elsewhere they
/// end in the medium in which they begin, and what makes them attenuates them.
struct ShadowMediaColumns {
    ShadowColumns shadows;  ///< in and out
    HitView hits;           ///< nearest ones; without columns: the rays reach their lights
    const uint8_t* occluded = nullptr;  ///< only rays with 0 count; null: all
    const uint32_t* shadow_media;       ///< by sample index: medium stack where the ray begins
};

/// One step of transparent shadow rays: up to the next thin wall.
struct ThinWallStep {
    uint32_t segment = 0;
    uint32_t number = 0;
    bool random = true;  ///< texels are drawn; else filtered
};

/// Camera rays that hit shadow catchers (docs/visibility.md), maybe through clear glass, and what
/// they become there.
struct CatcherColumns {
    PathView paths;
    HitView hits;             ///< those of the ground, which is no geometry, have the primitive -1
    PathColumns next;         ///< out, packed from index first_next on
    PathColumns reflections;  ///< out, packed from first_reflection on, if `reflects`
    ShadowColumns shadows;    ///< out, packed, one per sample
    const float* time = nullptr;           ///< by sample index; null: nothing moves
    LitPointRecord* lit_points = nullptr;  ///< as in ShadeColumns
    float ground_m = 0;                    ///< height of the ground
    int bounce = 0;                        ///< surfaces that the paths have met before
    int first_next = 0;
    int first_reflection = 0;
    bool reflects = false;
};

/// Sizes of the columns that shade_catchers writes.
struct CatcherCounts {
    int next = 0;
    int shadow = 0;
    int reflections = 0;  ///< with those before first_reflection
};

/// The start of random walks inside scattering media.
struct ScatterStart {
    PathView paths;               ///< all paths of a bounce
    HitView hits;                 ///< what they hit
    PathColumns random_walks;     ///< out: those of them inside such media, packed
    HitColumns random_walk_hits;  ///< out: what these hit
    uint32_t* path_index;         ///< out: of a random walk, in `paths`
};

/// One flight of random-walk paths, and the shadow rays of those that scatter.
struct ScatterColumns {
    PathColumns paths;                    ///< out, by index: random walks that are done
    HitColumns hits;                      ///< out: what they hit
    PathColumns random_walks;             ///< in and out, packed in place
    HitView random_walk_hits;             ///< what these hit
    uint32_t* path_index;                 ///< in and out: of a random walk, in `paths`
    ShadowColumns shadows;                ///< out, packed, where Flight::samples_lights
    uint32_t* shadow_media;               ///< as in ShadeColumns
    const float* time;                    ///< likewise
    const LightPathColumns* light_paths;  ///< likewise
    LitPointRecord* lit_points;           ///< likewise
};

/// Sizes of the columns that a flight writes.
struct ScatterCounts {
    int random_walks = 0;
    int shadow = 0;
};

/// Paths whose hit may coincide with faces of other media, and the probe rays that find those:
/// along the normal through the hit, from the viewer's side.
struct ProbeColumns {
    PathView paths;
    HitView hits;                 ///< what they hit
    const float* time = nullptr;  ///< by sample index; null: nothing moves
    /// By sample index: probes are made only where faces_shared; null: everywhere.
    const SharedFaces* shared = nullptr;
    /// Out, packed. The colour channels hold distances: of the hit along the probe; of the path's
    /// start before the hit, along the normal; at which rays start clear of the hit.
    ShadowColumns probes;
    uint32_t* path_index;  ///< out: a probe's index in `paths`, with seen_from_front
};

// The unit of distances around a hit is the clearance: HitGeometry::offset, at which rays start
// clear of the face that they leave. Nearer faces are within the rounding of Embree and shading.

/// Faces closer together than this coincide: a ray that starts clear of one would miss the other.
inline constexpr float coincidence_distance = 2.0f;

/// Length of a probe behind the hit: a chain of faces, each coincident with the next, may be longer
/// than coincidence_distance.
inline constexpr float probe_distance = 10.0f;

/// Bit in ProbeColumns::path_index: the path comes from the front of the face it hit.
inline constexpr uint32_t seen_from_front = 1U << 31;

/// One flight between two scatterings.
struct Flight {
    int bounce = 0;
    int number = 0;  ///< since the last surface
    bool last = false;
    bool samples_lights = false;  ///< in media like air, and in the one around the camera
};

/// One instruction set's stages. To add a stage: declare it here, define it in its own numbered
/// file, list the file in src/CMakeLists.txt (stages_sources) and the function in isa_entry.cpp,
/// call it from wavefront.cpp, and enter it in the table of path_state.h and in
/// tests/stages/path_state_test.cpp.
struct StageTable {
    const char* isa;
    int lanes;

    /// Stage 1: one camera ray per sample; samples are cleared.
    void (*camera)(
        const BatchSettings&, int count, const PathColumns&, const SampleColumns&, float* length_m);

    /// Stage 1 for AOVs: one ray per pixel; only the columns that AOVs read.
    void (*centre_camera)(const BatchSettings&, int count, const PathColumns&, float* length_m);

    /// Stage 1, if something moves: the time of every sample.
    void (*open_shutter)(
        const SceneView&, bool through_centres, int count, const PathColumns&, float* time);

    /// Stage 2, inside scattering media: finds the paths there, then makes one flight of each.
    int (*begin_scatter)(const SceneView&, int count, const ScatterStart&);
    ScatterCounts (*scatter)(
        const SceneView&, const BatchSettings&, const Flight&, int count, const ScatterColumns&);

    /// Stage 2, where media touch: probe rays that find coincident faces. Returns how many.
    int (*make_probes)(const SceneView&, int count, const ProbeColumns&);

    /// Stage 3: hits become radiance, shadow rays and next rays; misses see the environment.
    ShadeCounts (*shade)(
        const SceneView&, const BatchSettings&, int bounce, int count, const ShadeColumns&);

    /// Stage 3 at shadow catchers: camera rays become shadow rays and next rays.
    CatcherCounts (*shade_catchers)(const SceneView&, int count, const CatcherColumns&);

    /// Stage 3 for --integrator ao: one occlusion ray per hit.
    int (*shade_ao)(const SceneView&, const BatchSettings&, int count, const ShadeColumns&);

    /// Stage 3 for --integrator raycast: the number of hits, which come to the front; then their
    /// shadow rays, range by range.
    int (*begin_raycast)(const SceneView&, const BatchSettings&, int count, const ShadeColumns&);
    int (*shade_raycast)(const SceneView&, const RaycastRange&, const RaycastColumns&);

    /// Stage 3 for AOVs: every sample is written; 0 where nothing was hit.
    void (*aovs)(const SceneView&, const BatchSettings&, int count, const AovColumns&);

    /// Stage 3 for the AOV `albedo`, from the second bounce on. Returns how many paths still look
    /// for theirs.
    int (*follow_albedo)(
        const SceneView&, const BatchSettings&, int bounce, int count, const AlbedoColumns&);

    /// Stage 3 for --integrator wireframe: every sample is written.
    void (*wireframe)(const SceneView&, const BatchSettings&, int count, const WireframeColumns&);

    /// Stage 4, if shadow rays pass the boundaries of media: attenuates them up to the next one.
    void (*absorb_shadows)(const SceneView&, int count, const ShadowMediaColumns&);

    /// Stage 4, if there are thin walls: packs the shadow rays that wait there, then steps each.
    int (*take_waiting)(int count, const uint8_t* occluded, const ShadowColumns&);
    int (*cross_thin_walls)(const SceneView&,
                            const ThinWallStep&,
                            int count,
                            const ThinWallColumns&);

    /// Stage 5a: unoccluded shadow rays are added to their samples.
    void (*add_shadows)(int count,
                        const ShadowView&,
                        const uint8_t* occluded,
                        const SampleColumns&);

    /// Stage 5a, where light layers are asked for: and to their layers.
    void (*add_shadow_layers)(const LightPathColumns&,
                              int count,
                              const ShadowView&,
                              const uint8_t* occluded);

    /// Stage 5b: adds each pixel's samples to its sum, in sample order.
    uint64_t (*accumulate)(int pixels, const SampleRange&, const SampleColumns&, PixelSum* sums);

    /// Stage 5 for AOVs, whose samples are pixels: clears those that are not finite and returns
    /// their number.
    uint64_t (*clear_nonfinite)(int count, const SampleColumns&);
};

}  // namespace obscura
