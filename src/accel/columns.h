// accel/columns.h - rays, hits and other query data as columns (SoA).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/column_list.h"

#include <cstdint>

namespace obscura {

/// tfar of rays without an end.
inline constexpr float unlimited = 3.0e38f;

/// Rays as columns, padded to a multiple of 16.
struct RayColumns {
    const float *ox, *oy, *oz;  ///< origin, metres
    const float *dx, *dy, *dz;  ///< unit direction
    const float* tfar;          ///< null: unlimited
    /// Random key for alpha decisions, different for every path; null: alpha BLEND is a threshold
    /// at 0.5.
    const uint32_t* key;
    int count;
    const float* time = nullptr;  ///< shutter time in [0, 1]; null: 0
};

/// The hit surface, as indices of the records in the scene's tables.
struct SceneRecords {
    int32_t instance = -1;
    int32_t primitive = -1;  ///< -1: nothing
};

/// A crossing of a ray with a medium's boundary.
struct Crossing {
    float t = 0, u = 0, v = 0;
    SceneRecords surface;
    int32_t triangle = 0;
    int32_t medium = 0;   ///< its number, see scene/media.h
    bool enters = false;  ///< the ray comes from the front
};

/// A surface that a ray meets.
struct MetSurface {
    int index = 0;  ///< of the ray
    SceneRecords surface;
};

/// The back face of a single-sided surface that a camera ray passed.
struct PassedBack {
    int index = 0;  ///< of the ray
    float t = 0;    ///< distance of the back face
    SceneRecords surface;
};

/// Faces that a path ignores: those of one surface whose back faces the eye.
struct CutFaces {
    SceneRecords surface;
    float eye[4] = {0, 0, 0, 1};  ///< homogeneous: w is 0 where the view is parallel
};

/// The cut-away faces of a column of rays.
struct Cutaway {
    const CutFaces* faces = nullptr;  ///< by sample index
    const uint32_t* slot = nullptr;   ///< sample index of each ray

    const CutFaces& of(int index) const { return faces[slot[index]]; }
};

/// Whether any face is cut away for a ray.
inline bool cuts(const Cutaway& cutaway, int index) {
    return cutaway.of(index).surface.primitive >= 0;
}

/// Distance along the ray; position on the surface; indices in Scene::instances (-1: a primitive in
/// world space) and in Scene::primitives (-1: a miss, which leaves the other columns undefined);
/// triangle within the primitive.
#define OBSCURA_HIT_COLUMNS(VECTOR, NUMBER, WORD, INTEGER) \
    NUMBER(t)                                              \
    NUMBER(u)                                              \
    NUMBER(v)                                              \
    INTEGER(instance)                                      \
    INTEGER(primitive)                                     \
    INTEGER(triangle)

/// Hits as columns, padded like the rays: whole blocks are written.
OBSCURA_COLUMNS(HitColumnsOf, OBSCURA_HIT_COLUMNS);
using HitColumns = HitColumnsOf<float>;
using HitView = HitColumnsOf<const float>;

/// Light and transmittance of Gaussian splats along rays, as columns.
struct SplatColumns {
    float *r, *g, *b;      ///< their own light
    float* transmittance;  ///< for light from behind them
};

}  // namespace obscura
