// accel/packets.h - moves rays and hits between columns and Embree's packets of 16.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/columns.h"
#include "accel/embree.h"

#include <algorithm>

namespace obscura {

/// Rays in a packet.
inline constexpr int packet = 16;

/// One for each lane of a packet: -1 where Embree shall look at it, else 0.
struct alignas(64) ValidMask {
    int lane[packet];
};

/// Fills what PacketMoves::load leaves as it is; once for all packets of a call.
inline void begin_packets(RTCRay16& out) {
    std::fill_n(out.tnear, packet, 0.0f);
    std::fill_n(out.time, packet, 0.0f);
    std::fill_n(out.mask, packet, 0xFFFFFFFFU);
    std::fill_n(out.flags, packet, 0U);
}

/// Compiled once per instruction set, for every ray passes here.
struct PacketMoves {
    /// Loads the rows [first, first + 16), whose ids are their numbers; false, with a packet that
    /// must not be used, when one of them is not safe (accel/safe_ray.h).
    bool (*load)(const RayColumns& rays, int first, RTCRay16& out);

    /// Writes 16 rows of hits, as of a scene without instances.
    void (*store)(const RTCRayHit16& block,
                  const ValidMask& valid,
                  const HitColumns& hits,
                  int first);
};

}  // namespace obscura
