// accel/safe_ray.h - tests whether Embree can take a ray, and loads rays for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/columns.h"
#include "accel/embree.h"
#include "scene/ray_reach.h"

#include <algorithm>
#include <cmath>

namespace obscura {

/// True when Embree can take the ray: finite, within the scene's reach, and with a direction.
inline bool is_safe(const RayColumns& rays, int i, const RayReach& reach) {
    const float origin = std::fabs(rays.ox[i]) + std::fabs(rays.oy[i]) + std::fabs(rays.oz[i]);
    const float direction = std::fabs(rays.dx[i]) + std::fabs(rays.dy[i]) + std::fabs(rays.dz[i]);
    const bool far_ok = rays.tfar == nullptr || rays.tfar[i] >= 0.0f;
    return (origin <= reach.origin) & (direction <= reach.direction) & (direction > 0.0f) &
           far_ok;  // no branches: a loop over rays becomes vector code
}

/// Loads one ray in Embree's layout; its id is its index.
inline void load_ray(const RayColumns& rays, int index, RTCRay& out) {
    out.org_x = rays.ox[index];
    out.org_y = rays.oy[index];
    out.org_z = rays.oz[index];
    out.dir_x = rays.dx[index];
    out.dir_y = rays.dy[index];
    out.dir_z = rays.dz[index];
    out.tnear = 0.0f;
    out.tfar = rays.tfar != nullptr ? rays.tfar[index] : unlimited;
    out.time = rays.time != nullptr ? rays.time[index] : 0.0f;
    out.mask = 0xFFFFFFFFU;
    out.id = static_cast<unsigned>(index);
    out.flags = 0;
}

/// Loads one ray into one lane of a packet; its id is its index. begin_packets sets the rest.
inline void load_lane(const RayColumns& rays, int index, int lane, RTCRay16& out) {
    out.org_x[lane] = rays.ox[index];
    out.org_y[lane] = rays.oy[index];
    out.org_z[lane] = rays.oz[index];
    out.dir_x[lane] = rays.dx[index];
    out.dir_y[lane] = rays.dy[index];
    out.dir_z[lane] = rays.dz[index];
    out.tfar[lane] = rays.tfar != nullptr ? rays.tfar[index] : unlimited;
    if (rays.time != nullptr) out.time[lane] = rays.time[index];
    out.id[lane] = static_cast<unsigned>(index);
}

/// Sets the fields that PacketMoves::load does not write; once for all packets of a call.
inline void begin_packets(RTCRay16& out) {
    std::fill_n(out.tnear, 16, 0.0f);
    std::fill_n(out.time, 16, 0.0f);
    std::fill_n(out.mask, 16, 0xFFFFFFFFU);
    std::fill_n(out.flags, 16, 0U);
}

}  // namespace obscura
