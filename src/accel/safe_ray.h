// accel/safe_ray.h - which rays Embree may see, and how one is handed to it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/columns.h"
#include "accel/embree.h"
#include "scene/ray_reach.h"

#include <algorithm>
#include <cmath>

namespace obscura {

/// True when Embree may see the ray: finite, in the scene's reach, and with a direction.
inline bool is_safe(const RayColumns& rays, int i, const RayReach& reach) {
    const float origin = std::fabs(rays.ox[i]) + std::fabs(rays.oy[i]) + std::fabs(rays.oz[i]);
    const float direction = std::fabs(rays.dx[i]) + std::fabs(rays.dy[i]) + std::fabs(rays.dz[i]);
    const bool far_ok = rays.tfar == nullptr || rays.tfar[i] >= 0.0f;
    return (origin <= reach.origin) & (direction <= reach.direction) & (direction > 0.0f) &
           far_ok;  // no branches: a loop over rows becomes vector code
}

/// One row as Embree wants it; its id is the row.
inline void load_ray(const RayColumns& rays, int row, RTCRay& out) {
    out.org_x = rays.ox[row];
    out.org_y = rays.oy[row];
    out.org_z = rays.oz[row];
    out.dir_x = rays.dx[row];
    out.dir_y = rays.dy[row];
    out.dir_z = rays.dz[row];
    out.tnear = 0.0f;
    out.tfar = rays.tfar != nullptr ? rays.tfar[row] : unlimited;
    out.time = rays.time != nullptr ? rays.time[row] : 0.0f;
    out.mask = 0xFFFFFFFFU;
    out.id = static_cast<unsigned>(row);
    out.flags = 0;
}

/// One row as one lane of a packet; its id is the row. The rest is begin_packets'.
inline void load_lane(const RayColumns& rays, int row, int lane, RTCRay16& out) {
    out.org_x[lane] = rays.ox[row];
    out.org_y[lane] = rays.oy[row];
    out.org_z[lane] = rays.oz[row];
    out.dir_x[lane] = rays.dx[row];
    out.dir_y[lane] = rays.dy[row];
    out.dir_z[lane] = rays.dz[row];
    out.tfar[lane] = rays.tfar != nullptr ? rays.tfar[row] : unlimited;
    if (rays.time != nullptr) out.time[lane] = rays.time[row];
    out.id[lane] = static_cast<unsigned>(row);
}

/// Fills what PacketMoves::load leaves as it is; once for all packets of a call.
inline void begin_packets(RTCRay16& out) {
    std::fill_n(out.tnear, 16, 0.0f);
    std::fill_n(out.time, 16, 0.0f);
    std::fill_n(out.mask, 16, 0xFFFFFFFFU);
    std::fill_n(out.flags, 16, 0U);
}

}  // namespace obscura
