// accel/nearest_hits.h - the nearest hits of a packet, in whatever order Embree finds them.
// SPDX-License-Identifier: Apache-2.0
//
// Surfaces may lie in the same place: neighbouring triangles at their edge, coplanar ones all over.
// Of such surfaces Embree takes the last one that it tests. In which order it tests them depends on
// the other rays of the packet, and so does whether it tests them all: it leaves out what begins
// behind the hit so far, and the entry into a flat box is rounded otherwise than a hit in it.
// Obscura takes the surface with the lowest ids, and has Embree look a little beyond each hit.
#pragma once

#include "accel/embree.h"
#include "accel/packets.h"

namespace obscura {

struct alignas(64) NearestHits {
    float t[packet];
    int32_t instance[packet], geometry[packet], element[packet];
    float coordinates[packet];  ///< size of the numbers that a ray starts from: |x| + |y| + |z|
    int32_t first_id = 0;       ///< of the packet's rays: they are numbered on from it
};

/// Compiled once per instruction set, as every ray of a rendering passes here.
struct NearestHitCalls {
    /// Forgets the hits of another packet; the ids of this one begin with `first`.
    void (*begin)(const RTCRay16& rays, int first, NearestHits& nearest);

    /// Embree filter function: rejects the candidates that are not QueryContext::nearest.
    RTCFilterFunctionN keep_nearest;
};

inline namespace OBSCURA_ISA {

/// A candidate of one ray.
struct CandidateHit {
    float t;
    int32_t instance, geometry, element;
};

/// Whether a candidate is nearer than the hit so far, or as near and of lower ids. If so, it is the
/// hit from now on; if not, it is to be rejected.
OBSCURA_INLINE bool takes(NearestHits& nearest, int lane, const CandidateHit& candidate) {
    const int32_t instance = nearest.instance[lane];
    const int32_t geometry = nearest.geometry[lane];
    const bool has_lower_ids = candidate.instance != instance ? candidate.instance < instance
                               : candidate.geometry != geometry
                                   ? candidate.geometry < geometry
                                   : candidate.element < nearest.element[lane];
    const float t = nearest.t[lane];
    if (!(candidate.t < t || (candidate.t == t && has_lower_ids))) return false;
    nearest.t[lane] = candidate.t;
    nearest.instance[lane] = candidate.instance;
    nearest.geometry[lane] = candidate.geometry;
    nearest.element[lane] = candidate.element;
    return true;
}

/// How far Embree has to look for all that lies at the distance t. Hits and entries into boxes are
/// rounded to some 2^-20 of the numbers that they come from, more where rays graze them.
///
/// In      coordinates: as in NearestHits
template <typename T>
OBSCURA_INLINE T end_of_search(T t, T coordinates) {
    return t + (t + coordinates) * T(0x1p-14f);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
