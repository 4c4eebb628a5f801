// accel/columns.h - rays and hits as columns of plain numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/column_list.h"

#include <cstdint>

namespace obscura {

/// tfar of rays without an end.
inline constexpr float unlimited = 3.0e38f;

/// Rays as columns, padded to whole blocks of 16 rows.
struct RayColumns {
    const float *ox, *oy, *oz;  ///< origin, metres
    const float *dx, *dy, *dz;  ///< unit direction
    const float* tfar;          ///< null: unlimited
    /// random key for alpha decisions, another for every path; null: alpha BLEND is a cut at one
    /// half
    const uint32_t* key;
    int count;
    const float* time = nullptr;  ///< in [0, 1]; null: 0. What moves does so from 0 to 1
};

/// What a hit lies on, as rows of the scene's tables.
struct SceneRows {
    int32_t instance = -1;
    int32_t primitive = -1;  ///< -1: nothing
};

/// A face of a body that a ray goes through.
struct Crossing {
    float t = 0, u = 0, v = 0;
    SceneRows surface;
    int32_t triangle = 0;
    int32_t body = 0;     ///< number of its medium
    bool enters = false;  ///< the ray comes from the front
};

/// A camera ray that looked through the back of a single-sided surface.
struct PassedBack {
    int row = 0;  ///< of the ray
    float t = 0;  ///< how far away the back is
    SceneRows surface;
};

/// Faces that are not there for a path: those of one surface whose backs face the eye.
struct CutFaces {
    SceneRows surface;
    float eye[4] = {0, 0, 0, 1};  ///< homogeneous: w is 0 where the view is parallel
};

/// What is cut away for rays.
struct Cutaway {
    const CutFaces* faces = nullptr;  ///< by slot
    const uint32_t* slot = nullptr;   ///< by row of the rays

    const CutFaces& of(int row) const { return faces[slot[row]]; }
};

/// Whether anything is cut away for the row's ray.
inline bool cuts(const Cutaway& cutaway, int row) {
    return cutaway.of(row).surface.primitive >= 0;
}

/// Distance along the ray, place on the surface; the rows in Scene::instances (-1: a primitive in
/// world space) and in Scene::primitives (-1: a miss, and the other columns hold nothing of use);
/// the triangle within the primitive.
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

/// What Gaussian splats do to light along rays, as columns.
struct SplatColumns {
    float *r, *g, *b;      ///< their own light
    float* transmittance;  ///< share of the light from behind them that they leave
};

}  // namespace obscura
