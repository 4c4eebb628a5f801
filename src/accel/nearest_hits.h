// accel/nearest_hits.h - the nearest hits of a packet, in whatever order Embree finds them.
// SPDX-License-Identifier: Apache-2.0
//
// Surfaces may lie in the same place: neighbouring triangles at their edge, coplanar ones all over.
// Of such surfaces Embree takes the last one that it tests. In which order it tests them depends on
// the other rays of the packet, and so does whether it tests them all: it leaves out what begins
// behind the hit so far, and the entry into a flat box is rounded otherwise than a hit in it.
// Obscura takes the surface with the lowest ids, and has Embree look a little beyond each hit.
//
// Embree's documents let filters lower tfar. That they may raise it, too, rests on its kernels,
// which read it back after each filter and keep the old one of rejected hits; coplanar_test would
// show it if others did not.
#pragma once

#include "accel/embree.h"
#include "accel/packets.h"
#include "math/vec.h"

namespace obscura {

/// The nearest hits so far of a packet's rays.
struct alignas(64) NearestHits {
    float t[packet];  ///< their distances; infinity: none. Embree's tfar is a little more
    int32_t instance[packet], geometry[packet], element[packet];
    float coordinates[packet];  ///< size of the numbers that distances are computed from
    int32_t first_id = 0;       ///< of the packet's rays: they are numbered on from it
};

/// Compiled once per instruction set, as every ray of a rendering passes here.
struct NearestHitCalls {
    /// Begins a packet, whose ids begin with `first`: it has no hits yet.
    ///
    /// In      scene_size: its largest coordinate
    void (*begin)(const RTCRay16& rays, int first, float scene_size, NearestHits& nearest);

    /// Embree filter function: rejects the candidates that are not QueryContext::nearest.
    RTCFilterFunctionN keep_nearest;
};

inline namespace OBSCURA_ISA {

/// The nearest hits of a ray's packet.
OBSCURA_INLINE NearestHits& nearest_hits_of(const QueryContext& context, unsigned ray) {
    const unsigned number = ray - static_cast<unsigned>(context.nearest->first_id);
    return context.nearest[number / packet];
}

/// A candidate of one ray.
struct CandidateHit {
    float t;
    int32_t instance, geometry, element;
};

/// Whether a candidate is nearer than the hit so far, or as near and of lower ids. If so, it is the
/// hit from now on; if not, it is to be rejected.
OBSCURA_INLINE bool takes(NearestHits& nearest, int lane, const CandidateHit& candidate) {
    const float t = nearest.t[lane];
    if (!(candidate.t <= t)) return false;
    if (candidate.t == t) {
        const int32_t instance = nearest.instance[lane];
        const int32_t geometry = nearest.geometry[lane];
        if (candidate.instance != instance) {
            if (candidate.instance > instance) return false;
        } else if (candidate.geometry != geometry) {
            if (candidate.geometry > geometry) return false;
        } else if (candidate.element >= nearest.element[lane]) {
            return false;
        }
    }
    nearest.t[lane] = candidate.t;
    nearest.instance[lane] = candidate.instance;
    nearest.geometry[lane] = candidate.geometry;
    nearest.element[lane] = candidate.element;
    return true;
}

/// Size of the numbers that a distance in an instance's own space is computed from, in units of
/// distance. Zero for a ray without direction.
template <typename T>
OBSCURA_INLINE T own_coordinates(const Vec3<T>& origin, const Vec3<T>& direction) {
    const T length = abs(direction.x) + abs(direction.y) + abs(direction.z);
    const T size = abs(origin.x) + abs(origin.y) + abs(origin.z);
    return select(length > T(0.0f), T(2.0f) * size / length, T(0.0f));  // length <= 2 |direction|
}

/// How far Embree has to look for all that lies at the distance t. Hits and entries into boxes are
/// rounded to some 2^-20 of the numbers that they come from, more where rays graze them.
///
/// In      coordinates: as in NearestHits, or of the space of the hit, where they are larger
template <typename T>
OBSCURA_INLINE T end_of_search(T t, T coordinates) {
    return t + (t + coordinates) * T(0x1p-14f);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
