// accel/packets.h - moves rays and hits between columns and Embree's packets of 16.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/columns.h"
#include "accel/embree.h"
#include "scene/ray_reach.h"

namespace obscura {

/// Rays in a packet.
inline constexpr int packet = 16;

/// Embree's mask of a packet's active lanes: -1 active, else 0.
struct alignas(64) ValidMask {
    int lane[packet];
};

/// Compiled once per instruction set, as every ray of a rendering passes here.
struct PacketMoves {
    /// Loads the rays [first, first + 16), whose ids are their indices. False if one of them is not
    /// safe (accel/safe_ray.h); the packet must not be used then.
    bool (*load)(const RayColumns& rays, int first, const RayReach& reach, RTCRay16& out);

    /// Writes 16 hits, for scenes without instances.
    void (*store)(const RTCRayHit16& block,
                  const ValidMask& valid,
                  const HitColumns& hits,
                  int first);
};

}  // namespace obscura
