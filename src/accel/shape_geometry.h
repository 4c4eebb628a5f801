// accel/shape_geometry.h - analytic shapes as Embree user geometry: callbacks and what they read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/embree.h"
#include "math/transform.h"
#include "shape/shape_row.h"
#include "shape/sphere_cluster.h"

#include <cstdint>

namespace obscura {

struct AlphaGeometry;

/// What the user geometry of one primitive knows; the geometry's user pointer.
struct ShapeGeometry {
    const ShapeRow* rows = nullptr;  ///< by Embree's primitive; null: spheres
    const float* spheres = nullptr;  ///< blocks; a cluster is an Embree primitive
    int32_t count = 0;               ///< rows, or spheres
    bool single_sided = false;
    bool wall = false;                     ///< it may be a thin wall
    const AlphaGeometry* alpha = nullptr;  ///< null: every point is opaque
    const float* boxes = nullptr;          ///< of the clusters of spheres
};

/// One place where a ray meets a shape, before anyone knows whether it counts.
struct ShapeCandidate {
    unsigned ray = 0;       ///< its id
    unsigned instance = 0;  ///< Embree's instance id
    int32_t row = 0;        ///< within the primitive
    int32_t root = 0;
    Vec3f position;  ///< in the shape's space
};

/// True unless alpha lets the ray pass there.
bool is_opaque_there(const ShapeGeometry& geometry,
                     const QueryContext& context,
                     const ShapeCandidate& candidate);

/// One place where a ray goes through a shape.
struct ShapeCrossing {
    float t = 0;
    unsigned geometry = 0;  ///< Embree's id
    unsigned instance = 0;  ///< likewise
    int32_t row = 0;        ///< within the primitive
    bool front = false;     ///< the ray comes from there
};

/// Takes all crossings where a query wants more than the nearest hit.
struct CrossingNotes {
    void (*note_shape)(CrossingNotes& notes, const ShapeCrossing& crossing) = nullptr;
};

/// The callbacks of one instruction set. Back faces of single-sided shapes do not count where
/// QueryContext::culls_back_faces; hits carry no u and v (shading rebuilds the point), and a
/// geometric normal against the ray.
struct ShapeCallbacks {
    RTCBoundsFunction bounds;
    RTCIntersectFunctionN intersect;
    RTCOccludedFunctionN occluded;
};

/// A plane without end, which no box can hold: tested beside the BVH.
struct EndlessPlane {
    ShapeGeometry geometry;
    ShapeRow row;
    int32_t primitive = 0;
    int32_t instance = -1;  ///< -1: in world space
    Affinef object_from_world;
};

/// The nearest hit of one ray with such a plane in (0, tfar]; found is false where it misses, or
/// where nothing is there.
NearHit<float> intersect_endless(const EndlessPlane& plane,
                                 const QueryContext& context,
                                 const ShapeRay<float>& ray,
                                 unsigned id,
                                 float tfar);

}  // namespace obscura
