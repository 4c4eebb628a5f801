// accel/alpha_filter.h - lets rays pass where a texture's alpha says that there is nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/embree.h"
#include "scene/scene.h"
#include "surface/texture.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// What an Embree geometry knows of its primitive; the geometry's user pointer.
struct AlphaGeometry {
    const Scene* scene = nullptr;
    TextureView textures;
    int32_t primitive = 0;
};

/// The key of a ray's alpha decisions in one segment of its path.
inline uint32_t segment_key(uint32_t path_key, uint32_t segment) {
    return path_key + segment * 0x27D4EB2FU;
}

/// 1 for every material whose factor and texture make a ray pass anywhere.
std::vector<uint8_t> find_materials_with_holes(const Scene& scene);

/// False where every point of the primitive is opaque, so that no filter is needed at all.
bool needs_alpha_filter(const Scene& scene,
                        const Primitive& primitive,
                        const std::vector<uint8_t>& materials_with_holes);

/// Alpha of a material where its base colour texture is read at `uv` (before the texture
/// transform).
float material_alpha(const AlphaGeometry& geometry, const Material& material, Vec2f uv);

/// What decides at one place: a ray's number, Embree's instance id, and the triangle, point or
/// piece of a line.
struct AlphaPlace {
    unsigned ray, instance, triangle;
};

/// The alpha from which on a hit counts.
float alpha_threshold(const AlphaGeometry& geometry,
                      const QueryContext& context,
                      const AlphaPlace& place);

/// False where alpha lets a ray pass a triangle, point or piece of a line: barycentric weighs its
/// second and third corner.
bool is_opaque_there(const AlphaGeometry& geometry,
                     const QueryContext& context,
                     const AlphaPlace& place,
                     Vec2f barycentric);

/// Embree filter for intersection and occlusion alike. A BLEND hit counts with probability alpha,
/// decided by a hash of (ray key, instance, geometry, triangle): the same answer however often and
/// in whatever order Embree asks.
void alpha_filter(const RTCFilterFunctionNArguments* args);

/// Embree filter for the occlusion of what may be a thin wall: QueryContext::passes_walls. It marks
/// a ray by whatever wall it meets, so that the order in which Embree asks says nothing.
void wall_filter(const RTCFilterFunctionNArguments* args);

/// The same where alpha is asked first.
void open_wall_filter(const RTCFilterFunctionNArguments* args);

}  // namespace obscura
