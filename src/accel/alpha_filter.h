// accel/alpha_filter.h - alpha, thin walls and visibility flags as Embree filter functions.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/embree.h"
#include "scene/scene.h"
#include "surface/texture.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// The filter functions that a primitive needs.
struct FilterKinds {
    bool alpha = false;
    bool thin_wall = false;   ///< possible thin wall; for shadow rays only
    bool visibility = false;  ///< it, or an instance of it, has flags of scene/visibility.h
    bool operator==(const FilterKinds&) const = default;
};

/// User pointer of an Embree geometry with filters.
struct AlphaGeometry {
    const Scene* scene = nullptr;
    TextureView textures;
    int32_t primitive = 0;
    FilterKinds kinds = {};
};

/// By primitive: 1 if it, or an instance of its mesh, has visibility flags. Empty if none has.
std::vector<uint8_t> find_visibility_filters(const Scene& scene);

/// True if the rays of a query pass a surface by its visibility flags.
///
/// In   instance: Embree's id
bool passes_surface(const AlphaGeometry& geometry, const QueryContext& context, unsigned instance);

/// The key of a ray's alpha decisions in one segment of its path.
inline uint32_t segment_key(uint32_t path_key, uint32_t segment) {
    return path_key + segment * 0x27D4EB2FU;
}

/// By material: 1 if its alpha may let a ray pass somewhere.
std::vector<uint8_t> find_materials_with_holes(const Scene& scene);

/// False if every point of the primitive is opaque.
bool needs_alpha_filter(const Scene& scene,
                        const Primitive& primitive,
                        const std::vector<uint8_t>& materials_with_holes);

/// Alpha of a material with its base colour texture read at `uv` (before the texture transform).
float material_alpha(const AlphaGeometry& geometry, const Material& material, Vec2f uv);

/// The inputs of one alpha decision: the ray's index, Embree's instance id, and the triangle, point
/// or curve segment.
struct AlphaCandidate {
    unsigned ray, instance, triangle;
};

/// The threshold: a hit counts if its alpha is at least this.
float alpha_threshold(const AlphaGeometry& geometry,
                      const QueryContext& context,
                      const AlphaCandidate& candidate);

/// False if alpha lets a ray pass a triangle, point or curve segment. barycentric: weights of its
/// second and third corner.
bool is_opaque_there(const AlphaGeometry& geometry,
                     const QueryContext& context,
                     const AlphaCandidate& candidate,
                     Vec2f barycentric);

/// Embree filter for intersection and occlusion. A BLEND hit counts with probability alpha, decided
/// by a hash of (ray key, instance, geometry, triangle), so that the answer does not depend on how
/// often and in which order Embree calls it.
void alpha_filter(const RTCFilterFunctionNArguments* args);

/// Embree occlusion filter of possible thin walls: see QueryContext::passes_thin_walls. Any thin
/// wall marks the ray, so that Embree's order of calls does not matter.
void thin_wall_filter(const RTCFilterFunctionNArguments* args);

/// The same for primitives whose alpha is tested first.
void alpha_thin_wall_filter(const RTCFilterFunctionNArguments* args);

/// Embree filters of primitives with visibility flags: these first, then what else the primitive
/// needs.
void visibility_filter(const RTCFilterFunctionNArguments* args);
void visibility_shadow_filter(const RTCFilterFunctionNArguments* args);

}  // namespace obscura
