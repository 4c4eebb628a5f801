// accel/shape_geometry.h - analytic shapes as Embree user geometry: callbacks and their data.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/embree.h"
#include "math/transform.h"
#include "shape/shape_record.h"
#include "shape/sphere_cluster.h"

#include <cstdint>

namespace obscura {

struct AlphaGeometry;

/// User pointer of a primitive of shapes.
struct ShapeGeometry {
    const ShapeRecord* records = nullptr;  ///< by Embree's primitive; null: spheres
    const float* spheres = nullptr;        ///< blocks; a cluster is an Embree primitive
    int32_t count = 0;                     ///< shapes, or spheres
    bool single_sided = false;
    bool thin_wall = false;                     ///< it may be a thin wall
    const AlphaGeometry* alpha = nullptr;       ///< null: every point is opaque
    const AlphaGeometry* visibility = nullptr;  ///< null: it has no visibility flags
    const float* boxes = nullptr;               ///< of the clusters of spheres
};

/// An intersection of a ray with a shape, before the alpha test.
struct ShapeCandidate {
    unsigned ray = 0;       ///< its id
    unsigned instance = 0;  ///< Embree's instance id
    int32_t index = 0;      ///< within the primitive
    int32_t root = 0;
    Vec3f position;  ///< in the shape's space
};

/// True unless alpha lets the ray pass there.
bool is_opaque_there(const ShapeGeometry& geometry,
                     const QueryContext& context,
                     const ShapeCandidate& candidate);

/// passes_surface for a primitive of shapes.
bool passes_shape(const ShapeGeometry& geometry, const QueryContext& context, unsigned instance);

/// An intersection of a ray with a shape, for Accel::list_crossings and Accel::list_surfaces.
struct ShapeCrossing {
    unsigned ray = 0;  ///< its id
    float t = 0;
    unsigned geometry = 0;  ///< Embree's id
    unsigned instance = 0;  ///< likewise
    int32_t index = 0;      ///< within the primitive
    bool front = false;     ///< the ray comes from the front
};

/// Receives all crossings of queries that ask for more than the nearest hit.
struct CrossingNotes {
    void (*note_shape)(CrossingNotes& notes, const ShapeCrossing& crossing) = nullptr;
};

/// The callbacks of one instruction set. They skip back faces of single-sided shapes if
/// QueryContext::culls_back_faces. Hits have no u and v (shading recomputes the point), and their
/// geometric normal faces the ray.
struct ShapeCallbacks {
    RTCBoundsFunction bounds;
    RTCIntersectFunctionN intersect;
    RTCOccludedFunctionN occluded;
};

/// An infinite plane, which no box can hold: tested apart from the BVH.
struct InfinitePlane {
    ShapeGeometry geometry;
    ShapeRecord record;
    int32_t primitive = 0;
    int32_t instance = -1;  ///< -1: in world space
    Affinef object_from_world;
};

/// The hit of one ray with an infinite plane in (0, tfar]; found is false if it misses, or if the
/// hit is culled or transparent.
NearHit<float> intersect_infinite_plane(const InfinitePlane& plane,
                                        const QueryContext& context,
                                        const ShapeRay<float>& ray,
                                        unsigned id,
                                        float tfar);

}  // namespace obscura
