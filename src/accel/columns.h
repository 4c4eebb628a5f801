// accel/columns.h - rays and hits as columns of plain numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

/// Embree's assertions refuse components of 1e30; its boxes hold up to 1.8e18.
inline constexpr float largest_component = 1.8e18f;
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

/// Hits as columns, padded like the rays: whole blocks are written. primitive -1 is a miss; the
/// other columns then hold nothing of use.
struct HitColumns {
    float *t, *u, *v;
    int32_t* instance;   ///< row in Scene::instances, -1 for world-space primitives
    int32_t* primitive;  ///< row in Scene::primitives
    int32_t* triangle;   ///< within the primitive
};

}  // namespace obscura
