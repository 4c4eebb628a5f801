// accel/embree.h - adapts Embree 3.13 and Embree 4 to one interface.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"

#if OBSCURA_EMBREE == 4  // the build says which one it found
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <vector>

namespace obscura {

struct CrossingNotes;
struct Cutaway;
struct NearestHits;
struct PassedBack;

/// Scene flag that Query::set_filter requires.
#if OBSCURA_EMBREE == 4
inline constexpr RTCSceneFlags query_filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
inline constexpr RTCSceneFlags query_filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// A query's data for filter functions and callbacks. The Embree part must come first: filters get
/// its address.
struct QueryContext {
#if OBSCURA_EMBREE == 4
    RTCRayQueryContext embree;
#else
    RTCIntersectContext embree;
#endif
    const unsigned* keys = nullptr;       ///< random key of each ray, indexed by the ray's id
    unsigned segment = 0;                 ///< mixed into the key
    bool fixed_threshold = false;         ///< alpha BLEND counts as MASK at 0.5
    bool culls_back_faces = false;        ///< of single-sided analytic shapes
    unsigned char passes = 0;             ///< visibility flags of absent surfaces, see SeeThrough
    bool passes_thin_walls = false;       ///< possible thin walls do not occlude
    unsigned char* thin_walls = nullptr;  ///< by ray id: set to 1 if the ray passes one
    std::vector<PassedBack>* passed_backs = nullptr;  ///< see SeeThrough
    const Cutaway* cutaway = nullptr;                 ///< likewise
    /// The nearest hits of each packet, as an array; null: hits are as Embree finds them.
    NearestHits* nearest = nullptr;
    CrossingNotes* crossings = nullptr;  ///< records all, hits nothing; see accel/crossings.cpp
};

/// Whether a shadow ray passes a possible thin wall; if so, records that.
OBSCURA_INLINE bool passes_thin_wall(const QueryContext& context, unsigned ray) {
    if (!context.passes_thin_walls) return false;
    if (context.thin_walls != nullptr) context.thin_walls[ray] = 1;
    return true;
}

/// Writes the instance stack of a user geometry's hit.
inline void copy_instance_stack(const QueryContext& context,
                                RTCHitN* hits,
                                unsigned n,
                                unsigned i) {
    for (unsigned level = 0; level < RTC_MAX_INSTANCE_LEVEL_COUNT; ++level) {
        RTCHitN_instID(hits, n, i, level) = context.embree.instID[level];
#if defined(RTC_GEOMETRY_INSTANCE_ARRAY)
        RTCHitN_instPrimID(hits, n, i, level) = context.embree.instPrimID[level];
#endif
    }
}

/// Settings of a query: the context, and whether the rays are coherent.
class Query {
public:
    Query(QueryContext& context, bool coherent) : context_(context) {
#if OBSCURA_EMBREE == 4
        rtcInitRayQueryContext(&context.embree);
        const auto flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
        rtcInitIntersectArguments(&intersect_);
        intersect_.flags = flags;
        intersect_.context = &context.embree;
        rtcInitOccludedArguments(&occluded_);
        occluded_.flags = flags;
        occluded_.context = &context.embree;
#else
        rtcInitIntersectContext(&context.embree);
        context.embree.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
    }

    /// Calls `filter` for every candidate hit, after the geometry's own filter.
    void set_filter(RTCFilterFunctionN filter) {
#if OBSCURA_EMBREE == 4
        constexpr auto asks = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
        intersect_.filter = filter;
        intersect_.flags = static_cast<RTCRayQueryFlags>(intersect_.flags | asks);
        occluded_.filter = filter;
        occluded_.flags = static_cast<RTCRayQueryFlags>(occluded_.flags | asks);
#else
        context_.embree.filter = filter;
#endif
    }

#if OBSCURA_EMBREE == 4
    void intersect1(RTCScene scene, RTCRayHit* ray) {
        rtcIntersect1(scene, ray, &intersect_);
    }
    void intersect4(const int* valid, RTCScene scene, RTCRayHit4* rays) {
        rtcIntersect4(valid, scene, rays, &intersect_);
    }
    void intersect8(const int* valid, RTCScene scene, RTCRayHit8* rays) {
        rtcIntersect8(valid, scene, rays, &intersect_);
    }
    void intersect16(const int* valid, RTCScene scene, RTCRayHit16* rays) {
        rtcIntersect16(valid, scene, rays, &intersect_);
    }
    void occluded1(RTCScene scene, RTCRay* ray) {
        rtcOccluded1(scene, ray, &occluded_);
    }
    void occluded4(const int* valid, RTCScene scene, RTCRay4* rays) {
        rtcOccluded4(valid, scene, rays, &occluded_);
    }
    void occluded8(const int* valid, RTCScene scene, RTCRay8* rays) {
        rtcOccluded8(valid, scene, rays, &occluded_);
    }
    void occluded16(const int* valid, RTCScene scene, RTCRay16* rays) {
        rtcOccluded16(valid, scene, rays, &occluded_);
    }
#else
    void intersect1(RTCScene scene, RTCRayHit* ray) {
        rtcIntersect1(scene, &context_.embree, ray);
    }
    void intersect4(const int* valid, RTCScene scene, RTCRayHit4* rays) {
        rtcIntersect4(valid, scene, &context_.embree, rays);
    }
    void intersect8(const int* valid, RTCScene scene, RTCRayHit8* rays) {
        rtcIntersect8(valid, scene, &context_.embree, rays);
    }
    void intersect16(const int* valid, RTCScene scene, RTCRayHit16* rays) {
        rtcIntersect16(valid, scene, &context_.embree, rays);
    }
    /// Streams of packets, all of whose rays are valid.
    void intersect_packets8(RTCScene scene, RTCRayHit8* packets, unsigned count) {
        auto* const rays = reinterpret_cast<RTCRayHitN*>(packets);
        rtcIntersectNM(scene, &context_.embree, rays, 8, count, sizeof(RTCRayHit8));
    }
    void intersect_packets16(RTCScene scene, RTCRayHit16* packets, unsigned count) {
        auto* const rays = reinterpret_cast<RTCRayHitN*>(packets);
        rtcIntersectNM(scene, &context_.embree, rays, 16, count, sizeof(RTCRayHit16));
    }
    void occluded1(RTCScene scene, RTCRay* ray) {
        rtcOccluded1(scene, &context_.embree, ray);
    }
    void occluded4(const int* valid, RTCScene scene, RTCRay4* rays) {
        rtcOccluded4(valid, scene, &context_.embree, rays);
    }
    void occluded8(const int* valid, RTCScene scene, RTCRay8* rays) {
        rtcOccluded8(valid, scene, &context_.embree, rays);
    }
    void occluded16(const int* valid, RTCScene scene, RTCRay16* rays) {
        rtcOccluded16(valid, scene, &context_.embree, rays);
    }
#endif

private:
    QueryContext& context_;
#if OBSCURA_EMBREE == 4
    RTCIntersectArguments intersect_;
    RTCOccludedArguments occluded_;
#endif
};

}  // namespace obscura
