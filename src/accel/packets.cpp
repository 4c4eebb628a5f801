// accel/packets.cpp - rays into packets and hits out; compiled once per instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "accel/packets.h"

#include "math/lanes.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

static_assert(packet % lane_count == 0);

/// Copies three columns; returns the sum of their sizes.
OBSCURA_INLINE Lanes copy3(const float* const (&from)[3], int index, float* const (&to)[3], int i) {
    Lanes sum(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const Lanes value = load(from[axis] + index);
        store(to[axis] + i, value);
        sum = sum + abs(value);
    }
    return sum;
}

bool load_rays(const RayColumns& rays, int first, const RayReach& reach, RTCRay16& out) {
    const Lanes farthest(reach.origin);
    const Lanes longest(reach.direction);
    bool safe = true;
    for (int i = 0; i < packet; i += lane_count) {
        const int index = first + i;
        const Lanes origin =
            copy3({rays.ox, rays.oy, rays.oz}, index, {out.org_x, out.org_y, out.org_z}, i);
        const Lanes direction =
            copy3({rays.dx, rays.dy, rays.dz}, index, {out.dir_x, out.dir_y, out.dir_z}, i);
        const Lanes end = rays.tfar != nullptr ? load(rays.tfar + index) : Lanes(unlimited);
        store(out.tfar + i, end);
        if (rays.time != nullptr) store(out.time + i, load(rays.time + index));
        store(reinterpret_cast<int32_t*>(out.id) + i, LanesI(index) + lane_numbers());
        safe = safe && all((origin <= farthest) & (direction <= longest) &
                           (direction > Lanes(0.0f)) & (end >= Lanes(0.0f)));
    }
    return safe;
}

void store_hits(const RTCRayHit16& block,
                const ValidMask& valid,
                const HitColumns& hits,
                int first) {
    static_assert(RTC_INVALID_GEOMETRY_ID == 0xFFFFFFFFU, "as int32_t it is -1, a miss");
    const LanesI none(-1);
    const auto words = [](const unsigned* column) {
        return reinterpret_cast<const int32_t*>(column);
    };
    for (int i = 0; i < packet; i += lane_count) {
        const int index = first + i;
        const LanesI idle = none - load(valid.lane + i);
        store(hits.t + index, load(block.ray.tfar + i));
        store(hits.u + index, load(block.hit.u + i));
        store(hits.v + index, load(block.hit.v + i));
        store(hits.triangle + index, load(words(block.hit.primID) + i));
        store(hits.primitive + index, load(words(block.hit.geomID) + i) | idle);
        store(hits.instance + index, none);
    }
}

}  // namespace

extern const PacketMoves packet_moves;
const PacketMoves packet_moves = {load_rays, store_hits};

}  // namespace OBSCURA_ISA
}  // namespace obscura
