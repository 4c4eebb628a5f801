// stages/doors.h - what passes between stages: columns of numbers and read-only tables.
// SPDX-License-Identifier: Apache-2.0
//
//   door         bytes/row  written by        read by
//   PathRows            68  camera, shade     intersect, scatter, shade
//   HitRows             24  intersect         scatter, shade
//   MissRows            36  shade (sort)      shade (miss)
//   ShadowRows          48  shade             shadow, accumulate
//   SampleRows          16  camera, shade,    accumulate
//                           accumulate
//
// A row is one path; a slot is a path's fixed place in its batch. Columns are 64-byte aligned and
// padded by 16 rows, so that a stage may read and write whole registers past the last row.
#pragma once

#include "accel/columns.h"
#include "camera/camera.h"
#include "light/environment.h"
#include "light/light_view.h"
#include "light/raycast_light.h"
#include "surface/texture.h"

#include <cstdint>

namespace obscura {

/// Rows in a batch: about 300 bytes each, 1.2 MB in all. Smaller ones stay in nearer caches, larger
/// ones leave Embree the hierarchy warm for longer; this was the fastest of 512 to 16384.
inline constexpr int batch_rows = 4096;

/// Paths that still travel, packed.
struct PathRows {
    float *ox, *oy, *oz;  ///< ray origin, metres
    float *dx, *dy, *dz;  ///< unit direction
    float *tr, *tg, *tb;  ///< throughput
    float* pdf;           ///< density of this direction, 1/sr; 0: chosen without one (camera)
    float* cone_width;    ///< footprint at the origin, metres
    float* cone_spread;   ///< growth of the footprint, metres per metre
    uint32_t* slot;
    uint32_t* key;     ///< of the pixel's random numbers
    uint32_t* sample;  ///< sample number, bits reversed
    uint32_t*
        path_key;  ///< of the path: decides at alpha BLEND surfaces, between pixels, within bodies
    uint32_t* bodies;  ///< what the ray travels in, see stages/3_media.h
};

using HitRows = HitColumns;

/// Paths that left the scene.
struct MissRows {
    float *dx, *dy, *dz;
    float *tr, *tg, *tb;
    float* pdf;
    uint32_t* slot;
    uint32_t* path_key;
};

/// Light that arrives if nothing is in the way.
struct ShadowRows {
    float *ox, *oy, *oz;
    float *dx, *dy, *dz;
    float* tfar;
    float *r, *g, *b;  ///< contribution to the slot's radiance
    uint32_t* slot;
    uint32_t* path_key;
};

/// One radiance a slot.
struct SampleRows {
    float *r, *g, *b, *a;
};

inline constexpr int words_per_path = 17, words_per_hit = 6, words_per_miss = 9,
                     words_per_shadow = 12, words_per_sample = 4;
static_assert(sizeof(PathRows) == words_per_path * sizeof(void*));
static_assert(sizeof(HitRows) == words_per_hit * sizeof(void*));
static_assert(sizeof(MissRows) == words_per_miss * sizeof(void*));
static_assert(sizeof(ShadowRows) == words_per_shadow * sizeof(void*));
static_assert(sizeof(SampleRows) == words_per_sample * sizeof(void*));

inline constexpr int affine_words = 12;

/// What moves while the shutter is open: see Motion in scene/scene.h.
struct MotionView {
    int steps = 1;
    const float* positions = nullptr;  ///< null: no vertex moves
    const float* normals = nullptr;
    const float* instances = nullptr;  ///< rows of affine_words; null: no instance moves
    int camera_steps = 1;
    /// Rows of affine_words: what the camera has moved by since the shutter opened; null: it stands
    const float* camera = nullptr;
};

inline bool moves(const MotionView& motion) {
    return motion.steps > 1 || motion.camera_steps > 1;
}

/// The scene as the stages see it: raw tables, all read by gathers.
struct SceneView {
    const float* positions = nullptr;
    float edge_scale = 1;  ///< see scene/edge_scale.h
    const int32_t* indices = nullptr;
    const float* attributes = nullptr;
    const float* shapes = nullptr;   ///< ShapeRow as words; null: the scene has no shapes at all
    const float* spheres = nullptr;  ///< see shape/sphere_block.h; null: none
    const float* curve_points = nullptr;       ///< x, y, z, radius; null: there are no lines
    const int32_t* curve_segments = nullptr;   ///< first point of each
    const int32_t* primitives = nullptr;       ///< Primitive as words
    const float* instances = nullptr;          ///< Instance as words
    const float* materials = nullptr;          ///< Material as words
    const float* layers = nullptr;             ///< MaterialLayers as words
    const float* media = nullptr;              ///< Medium as words; null: no body has a volume
    const int32_t* touching_bodies = nullptr;  ///< by primitive; null: no faces are shared
    bool scatters = false;                     ///< some medium scatters light
    bool occludes = false;    ///< some material has an occlusion texture: stages/3_occlusion.h
    bool thin_walls = false;  ///< some surface may let light pass straight: surface/thin_wall.h
    const int32_t* material_numbers = nullptr;  ///< in glTF, by row; -1: none
    MotionView motion;
    TextureView textures;
    LightView lights;
    RaycastView raycast;  ///< for --integrator raycast alone
    EnvironmentView environment;
    bool has_environment = false;
};

/// What a path goes through together with the face that it hit: faces of bodies that lie in the
/// same place but for rounding. One a slot; see stages/shared_faces.h.
struct SharedFaces {
    uint32_t left = 0;     ///< numbers of up to three bodies, as PathRows::bodies; see faces_shared
    uint32_t entered = 0;  ///< likewise
    float before = 0;  ///< how far before the hit, and beyond it, rays start clear of all of them
    float beyond = 0;
};

inline constexpr int shared_faces_words = 4;
static_assert(sizeof(SharedFaces) == shared_faces_words * 4, "read as 32-bit words");

/// In SharedFaces::left: there are such faces.
inline constexpr uint32_t faces_shared = 1U << 31;

/// Which light transport strategies count; bit 0 light sampling, bit 1 BSDF sampling.
inline constexpr int sample_lights = 1, sample_bsdfs = 2;

/// What a whole batch shares.
struct BatchSettings {
    Camera camera;
    int width = 0, height = 0;         ///< film, pixels
    const int32_t* pixel_x = nullptr;  ///< by pixel of the tile
    const int32_t* pixel_y = nullptr;
    int samples = 1;  ///< per pixel in this batch; slot = pixel * samples + i
    uint32_t first_sample = 0;
    uint32_t seed_low = 0, seed_high = 0;
    const float* filter = nullptr;  ///< inverse CDF, filter_entries + 1 offsets; null: box
    int max_bounces = 8;
    uint32_t bodies = 0;  ///< around the camera, see stages/3_media.h
    int strategies = sample_lights | sample_bsdfs;
    bool background_visible = true;      ///< camera rays that miss see the environment
    float background[4] = {0, 0, 0, 0};  ///< added where camera rays miss; premultiplied RGBA
    float ao_distance = 0;
    /// Of the area that a pixel's cone covers: what one look-up of a texture stands for.
    float footprint_share = 1;
    bool through_centres = false;      ///< all samples: through the pixel's and the lens' middle
    float film_offset_px[2] = {0, 0};  ///< of centre rays, from the pixel's centre
    float wire_width_px = 1;
};

inline constexpr int filter_entries = 256;

struct BatchCounters {
    uint64_t nonfinite = 0;
};

}  // namespace obscura
