// accel/packets.h - moves rays and hits between columns and Embree's packets of 16.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/columns.h"
#include "accel/embree.h"
#include "scene/ray_reach.h"

namespace obscura {

/// Rays in a packet.
inline constexpr int packet = 16;

/// One for each lane of a packet: -1 where Embree shall look at it, else 0.
struct alignas(64) ValidMask {
    int lane[packet];
};

/// Compiled once per instruction set: every ray of a rendering comes this way.
struct PacketMoves {
    /// Loads the rows [first, first + 16), whose ids are their numbers; false, with a packet that
    /// must not be used, when one of them is not safe (accel/safe_ray.h).
    bool (*load)(const RayColumns& rays, int first, const RayReach& reach, RTCRay16& out);

    /// Writes 16 rows of hits, as of a scene without instances.
    void (*store)(const RTCRayHit16& block,
                  const ValidMask& valid,
                  const HitColumns& hits,
                  int first);
};

}  // namespace obscura
