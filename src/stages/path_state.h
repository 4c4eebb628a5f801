// stages/path_state.h - the path state in columns (SoA), and the read-only scene tables.
// SPDX-License-Identifier: Apache-2.0
//
// Which stages may write which columns. tests/stages/path_state_test.cpp compares the table with
// the types of their arguments. Hits come from accel/.
//
//   PathColumns    68 bytes
//     written:  camera centre_camera open_shutter begin_scatter scatter shade shade_catchers
//               shade_ao begin_raycast follow_albedo
//     only read:  make_probes shade_raycast aovs wireframe
//   HitColumns     24 bytes
//     written:  begin_scatter scatter shade shade_ao begin_raycast follow_albedo
//     only read:  make_probes shade_catchers shade_raycast aovs wireframe absorb_shadows
//               cross_thin_walls
//   MissColumns    36 bytes
//     written:  shade shade_ao begin_raycast
//   ShadowColumns  48 bytes
//     written:  scatter make_probes shade shade_catchers shade_ao begin_raycast shade_raycast
//               take_waiting absorb_shadows cross_thin_walls
//     only read:  add_shadows add_shadow_layers
//   SampleColumns  16 bytes
//     written:  camera shade shade_ao begin_raycast shade_raycast wireframe cross_thin_walls
//               add_shadows accumulate clear_nonfinite
//
// A batch holds one path per sample; the sample index is a path's fixed number in its batch.
// Columns are 64-byte aligned and padded by 16 entries, so that a stage may read and write whole
// registers past the last entry.
#pragma once

#include "accel/columns.h"
#include "camera/camera.h"
#include "light/environment.h"
#include "light/light_view.h"
#include "light/raycast_light.h"
#include "surface/texture.h"

#include <cstdint>

namespace obscura {

/// Samples in a batch at most: about 300 bytes each, 0.6 MB in all, and as much again for layers.
/// Smaller batches fit nearer caches, larger ones keep the BVH in the cache for longer; this was
/// the fastest of 1024 to 4096, by 3 % on a core with 1 MiB of second-level cache.
inline constexpr int batch_size = 2048;

// The lists of columns; see accel/column_list.h for what is made from them.

#define OBSCURA_PATH_COLUMNS(VECTOR, NUMBER, WORD, INTEGER)                                      \
    VECTOR(origin, ox, oy, oz)     /* of the ray, metres */                                      \
    VECTOR(direction, dx, dy, dz)  /* unit */                                                    \
    VECTOR(throughput, tr, tg, tb) /* fraction of the light that the pixel receives */           \
    NUMBER(pdf)                    /* of this direction, 1/sr; 0: chosen without one (camera) */ \
    NUMBER(cone_width)             /* footprint at the origin, metres */                         \
    NUMBER(cone_spread)            /* growth of the footprint, metres per metre */               \
    WORD(slot)                     /* sample index */                                            \
    WORD(key)                      /* of the pixel's random numbers */                           \
    WORD(sample)                   /* sample number, bits reversed */                            \
    WORD(path_key)     /* of the path: decides at alpha BLEND, between pixels, within media */   \
    WORD(medium_stack) /* what the ray travels in, see stages/3_media.h */

#define OBSCURA_MISS_COLUMNS(VECTOR, NUMBER, WORD, INTEGER) \
    VECTOR(direction, dx, dy, dz)                           \
    VECTOR(throughput, tr, tg, tb)                          \
    NUMBER(pdf)                                             \
    WORD(slot)                                              \
    WORD(path_key)

#define OBSCURA_SHADOW_COLUMNS(VECTOR, NUMBER, WORD, INTEGER)  \
    VECTOR(origin, ox, oy, oz)                                 \
    VECTOR(direction, dx, dy, dz)                              \
    NUMBER(tfar)                                               \
    VECTOR(radiance, r, g, b) /* contribution to its sample */ \
    WORD(slot)                                                 \
    WORD(path_key)

#define OBSCURA_SAMPLE_COLUMNS(VECTOR, NUMBER, WORD, INTEGER) \
    VECTOR(radiance, r, g, b)                                 \
    NUMBER(a)

/// Paths that still travel, packed.
OBSCURA_COLUMNS(PathColumnsOf, OBSCURA_PATH_COLUMNS);
using PathColumns = PathColumnsOf<float>;
using PathView = PathColumnsOf<const float>;

/// Paths that left the scene; a subset of the path columns.
OBSCURA_COLUMNS(MissColumnsOf, OBSCURA_MISS_COLUMNS);
using MissColumns = MissColumnsOf<float>;
using MissView = MissColumnsOf<const float>;

/// Light that arrives if nothing is in the way.
OBSCURA_COLUMNS(ShadowColumnsOf, OBSCURA_SHADOW_COLUMNS);
using ShadowColumns = ShadowColumnsOf<float>;
using ShadowView = ShadowColumnsOf<const float>;

/// One radiance per sample.
OBSCURA_COLUMNS(SampleColumnsOf, OBSCURA_SAMPLE_COLUMNS);
using SampleColumns = SampleColumnsOf<float>;
using SampleView = SampleColumnsOf<const float>;

/// What moves while the shutter is open: see Motion in scene/scene.h.
struct MotionView {
    int steps = 1;
    const float* positions = nullptr;  ///< null: no vertex moves
    const float* normals = nullptr;
    const Affinef* instances = nullptr;  ///< null: no instance moves
    int camera_steps = 1;
    const Affinef* camera = nullptr;  ///< movement since the shutter opened; null: it stands still
};

inline bool moves(const MotionView& motion) {
    return motion.steps > 1 || motion.camera_steps > 1;
}

struct Instance;
struct Material;
struct MaterialLayers;
struct Medium;
struct Primitive;
struct ShapeRecord;

/// The scene as the stages see it: raw tables, all read by gathers, whose members are named by
/// math/word_of.h.
struct SceneView {
    const float* positions = nullptr;
    float edge_scale = 1;  ///< see scene/edge_scale.h
    const int32_t* indices = nullptr;
    const float* attributes = nullptr;
    const ShapeRecord* shapes = nullptr;      ///< null: the scene has no shapes at all
    const float* spheres = nullptr;           ///< see shape/sphere_block.h; null: none
    const float* curve_points = nullptr;      ///< x, y, z, radius; null: there are no lines
    const int32_t* curve_segments = nullptr;  ///< first point of each
    const Primitive* primitives = nullptr;
    const Instance* instances = nullptr;
    bool stretches = false;  ///< some instance: see scene/stretch.h
    const Material* materials = nullptr;
    const MaterialLayers* layers = nullptr;
    const Medium* media = nullptr;            ///< null: no mesh bounds a medium
    const int32_t* touching_media = nullptr;  ///< by primitive; null: no faces are shared
    bool scatters = false;                    ///< some medium scatters light
    bool occludes = false;        ///< some material has an occlusion texture: stages/3_occlusion.h
    bool thin_walls = false;      ///< some may let light straight through: scene/thin_walls.h
    bool passable_media = false;  ///< shadow rays pass the boundary of some medium: likewise
    const int32_t* material_numbers = nullptr;  ///< glTF index of each material; -1: none
    MotionView motion;
    TextureView textures;
    LightView lights;
    RaycastView raycast;  ///< for --integrator raycast alone
    EnvironmentView environment;
    bool has_environment = false;
};

/// The changes of the medium stack at a hit where faces of several media coincide within rounding.
/// One per sample; see stages/shared_faces.h.
struct SharedFaces {
    uint32_t left = 0;     ///< up to three media, as PathColumns::medium_stack; see faces_shared
    uint32_t entered = 0;  ///< likewise
    float reflected_clearance = 0;    ///< from the hit to the start of rays, by side
    float transmitted_clearance = 0;  ///< likewise
};

inline constexpr int shared_faces_words = 4;
static_assert(sizeof(SharedFaces) == shared_faces_words * 4, "read as 32-bit words");

/// Bit in SharedFaces::left: there are coincident faces.
inline constexpr uint32_t faces_shared = 1U << 31;

/// Which light transport strategies count; bit 0 light sampling, bit 1 BSDF sampling.
inline constexpr int sample_lights = 1, sample_bsdfs = 2;

/// Bit in PathColumns::medium_stack: where BatchSettings::clear_spread asks for it, the path has
/// done something else than to pass clear glass.
inline constexpr uint32_t seen_unclearly = 1U << 26;

/// Settings of a whole batch.
struct BatchSettings {
    Camera camera;
    int width = 0, height = 0;         ///< film, pixels
    const int32_t* pixel_x = nullptr;  ///< by pixel of the tile
    const int32_t* pixel_y = nullptr;
    int samples = 1;  ///< per pixel in this batch; sample index = pixel * samples + i
    uint32_t first_sample = 0;
    uint32_t seed_low = 0, seed_high = 0;
    /// Pixels share their random numbers by z_order_sequence, each having 2 to the power of this;
    /// -1: each has a sequence of its own.
    int z_order_bits = -1;
    const float* filter = nullptr;  ///< inverse CDF, filter_entries + 1 offsets; null: box
    int max_bounces = 8;
    uint32_t medium_stack = 0;  ///< at the camera, see stages/3_media.h
    int strategies = sample_lights | sample_bsdfs;
    bool background_visible = true;      ///< camera rays that miss see the environment
    float background[4] = {0, 0, 0, 0};  ///< added where camera rays miss; premultiplied RGBA
    float ao_distance = 0;
    /// The fraction of a pixel cone's area that one texture look-up stands for.
    float footprint_fraction = 1;
    bool through_centres = false;      ///< all samples go through the centres of pixel and lens
    float film_offset_px[2] = {0, 0};  ///< of centre rays, from the pixel's centre
    float wire_width_px = 1;
    /// The most that a contribution may have, after one scattering and after several; 0: anything.
    /// See stages/contribution_limit.h.
    float clamp_direct = 0, clamp_indirect = 0;
    /// What smooth lobes do after a rough scattering: see stages/3_rough_paths.h.
    bool caustics = true;     ///< false: nothing
    bool regularize = false;  ///< they are widened, where there are caustics
    /// Transmission counts as clear where it spreads light no more than this, in metres per metre;
    /// below 0: no paths are told apart by that. See seen_unclearly.
    float clear_spread = -1;
};

inline constexpr int filter_entries = 256;

struct BatchCounters {
    uint64_t nonfinite = 0;
};

}  // namespace obscura
