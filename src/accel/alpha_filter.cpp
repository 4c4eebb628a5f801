// accel/alpha_filter.cpp - alpha, thin walls and visibility flags as Embree filter functions.
// SPDX-License-Identifier: Apache-2.0
#include "accel/alpha_filter.h"

#include "base/parallel.h"
#include "math/sampler.h"
#include "scene/lowest_texel.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

using Corners = std::array<uint32_t, 3>;

/// The vertices of a hit element: three of a triangle, two of a line, one of a point.
Corners corners_of(const Scene& scene, const Primitive& primitive, unsigned index) {
    const size_t at = static_cast<size_t>(primitive.first_triangle) + index;
    switch (static_cast<GeometryKind>(primitive.geometry)) {
        case GeometryKind::triangles:
            return {scene.indices[3 * at], scene.indices[3 * at + 1], scene.indices[3 * at + 2]};
        case GeometryKind::curves: {
            const uint32_t first = scene.curve_segments[at];
            return {first, first + 1, first};
        }
        case GeometryKind::shapes:
        case GeometryKind::spheres:
            break;
    }
    const auto vertex = static_cast<uint32_t>(at);
    return {vertex, vertex, vertex};
}

/// Interpolates one attribute's component over a triangle.
float interpolate(const Scene& scene, const Corners& corners, int32_t base, int width, Vec2f uv) {
    const auto at = [&](size_t corner) {
        const auto index = base + static_cast<int64_t>(corners[corner]) * width;
        return scene.attributes[static_cast<size_t>(index)];
    };
    return (1.0f - uv.x - uv.y) * at(0) + uv.x * at(1) + uv.y * at(2);
}

/// uv: of the mesh, before the slot's transform
float texture_alpha(const AlphaGeometry& geometry, const TextureSlot& slot, Vec2f uv) {
    const float* m = slot.uv_from_mesh;
    const Vec2f at{m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
    return sample_texture_bilinear<float>(geometry.textures, slot.texture, at, 0.0f).alpha;
}

float alpha_at(const AlphaGeometry& geometry, unsigned triangle, Vec2f barycentric) {
    const Scene& scene = *geometry.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(geometry.primitive)];
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    const Corners corners = corners_of(scene, primitive, triangle);
    float alpha = material.base_color[3];
    if (primitive.color_base != no_attribute) {
        alpha *= interpolate(scene, corners, primitive.color_base + 3, 4, barycentric);
    }
    const TextureSlot& slot = material.base_color_texture;
    const int32_t uv_base = primitive.uv_base[slot.uv_set];
    if (slot.texture >= 0 && uv_base != no_attribute) {
        const float u = interpolate(scene, corners, uv_base, 2, barycentric);
        const float v = interpolate(scene, corners, uv_base + 1, 2, barycentric);
        alpha *= texture_alpha(geometry, slot, {u, v});
    }
    return alpha;
}

}  // namespace

float material_alpha(const AlphaGeometry& geometry, const Material& material, Vec2f uv) {
    const TextureSlot& slot = material.base_color_texture;
    const float alpha = material.base_color[3];
    return slot.texture < 0 ? alpha : alpha * texture_alpha(geometry, slot, uv);
}

float alpha_threshold(const AlphaGeometry& geometry,
                      const QueryContext& context,
                      const AlphaCandidate& candidate) {
    const Scene& scene = *geometry.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(geometry.primitive)];
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    if ((material.flags & material_alpha_blend) == 0) return material.alpha_cutoff;
    if (context.fixed_threshold) return 0.5f;
    uint32_t hash = hash_word(segment_key(context.keys[candidate.ray], context.segment));
    hash = hash_word(hash + candidate.instance * 0x9E3779B9U);
    hash = hash_word(hash ^ (static_cast<uint32_t>(geometry.primitive) * 0x85EBCA6BU));
    hash = hash_word(hash + candidate.triangle * 0xC2B2AE35U);
    // In (0, 1]: alpha 0 never hits, alpha 1 always does.
    return unit_float<float>(hash) + 1.0f / 16777216.0f;
}

std::vector<uint8_t> find_materials_with_holes(const Scene& scene) {
    std::vector<uint8_t> holes(scene.materials.size(), 0);
    parallel_for(holes.size(), [&](size_t i) {
        const Material& material = scene.materials[i];
        const bool is_mask = (material.flags & material_alpha_mask) != 0;
        if (!is_mask && (material.flags & material_alpha_blend) == 0) return;
        constexpr int alpha = 3;
        const float lowest = material.base_color[3] *
                             lowest_texel(scene, material.base_color_texture.texture, alpha);
        holes[i] = lowest < (is_mask ? material.alpha_cutoff : 1.0f) ? 1 : 0;
    });
    return holes;
}

bool needs_alpha_filter(const Scene& scene,
                        const Primitive& primitive,
                        const std::vector<uint8_t>& materials_with_holes) {
    const auto index = static_cast<size_t>(primitive.material);
    constexpr uint32_t see_through = material_alpha_mask | material_alpha_blend;
    const bool colored = primitive.color_base != no_attribute;  // their alpha may be anything
    return materials_with_holes[index] != 0 ||
           (colored && (scene.materials[index].flags & see_through) != 0);
}

std::vector<uint8_t> find_visibility_filters(const Scene& scene) {
    if (scene.visibility.empty()) return {};
    std::vector<uint8_t> out = scene.visibility.primitives;
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        if (scene.visibility.instances[i] == 0) continue;
        const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[i].mesh)];
        const auto first = out.begin() + mesh.first_primitive;
        std::fill_n(first, mesh.primitive_count, uint8_t{1});
    }
    for (uint8_t& needed : out)
        needed = needed != 0 ? 1 : 0;
    return out;
}

bool passes_surface(const AlphaGeometry& geometry, const QueryContext& context, unsigned instance) {
    if (context.passes == 0) return false;
    const Scene& scene = *geometry.scene;
    // The still primitives, which have no instance of the scene's, come as one behind the others.
    const bool in_world = instance == RTC_INVALID_GEOMETRY_ID ||
                          instance == static_cast<unsigned>(scene.world_primitive_count) +
                                          static_cast<unsigned>(scene.instances.size());
    const int32_t number =
        in_world ? -1 : static_cast<int32_t>(instance) - scene.world_primitive_count;
    return (scene.visibility.of(geometry.primitive, number) & context.passes) != 0;
}

bool is_opaque_there(const AlphaGeometry& geometry,
                     const QueryContext& context,
                     const AlphaCandidate& candidate,
                     Vec2f barycentric) {
    return alpha_at(geometry, candidate.triangle, barycentric) >=
           alpha_threshold(geometry, context, candidate);
}

void alpha_filter(const RTCFilterFunctionNArguments* args) {
    const auto& geometry = *static_cast<const AlphaGeometry*>(args->geometryUserPtr);
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const unsigned triangle = RTCHitN_primID(args->hit, args->N, i);
        const Vec2f barycentric{RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i)};
        const AlphaCandidate candidate{
            RTCRayN_id(args->ray, args->N, i), RTCHitN_instID(args->hit, args->N, i, 0), triangle};
        if (!is_opaque_there(geometry, context, candidate, barycentric)) args->valid[i] = 0;
    }
}

void thin_wall_filter(const RTCFilterFunctionNArguments* args) {
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        if (passes_thin_wall(context, RTCRayN_id(args->ray, args->N, i))) args->valid[i] = 0;
    }
}

void alpha_thin_wall_filter(const RTCFilterFunctionNArguments* args) {
    alpha_filter(args);
    thin_wall_filter(args);
}

void visibility_filter(const RTCFilterFunctionNArguments* args) {
    const auto& geometry = *static_cast<const AlphaGeometry*>(args->geometryUserPtr);
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        if (passes_surface(geometry, context, RTCHitN_instID(args->hit, args->N, i, 0)))
            args->valid[i] = 0;
    }
    if (geometry.kinds.alpha) alpha_filter(args);
}

void visibility_shadow_filter(const RTCFilterFunctionNArguments* args) {
    visibility_filter(args);
    if (static_cast<const AlphaGeometry*>(args->geometryUserPtr)->kinds.thin_wall)
        thin_wall_filter(args);
}

}  // namespace obscura
