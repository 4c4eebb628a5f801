// accel/alpha_filter.cpp - alpha MASK and BLEND as Embree filter functions.
// SPDX-License-Identifier: Apache-2.0
#include "accel/alpha_filter.h"

#include "math/sampler.h"

namespace obscura {

namespace {

/// Interpolates one attribute's component over a triangle.
float interpolate(const Scene& scene, const uint32_t* corners, int32_t base, int width, Vec2f uv) {
    const auto at = [&](int corner) {
        const auto index = base + static_cast<int64_t>(corners[corner]) * width;
        return scene.attributes[static_cast<size_t>(index)];
    };
    return (1.0f - uv.x - uv.y) * at(0) + uv.x * at(1) + uv.y * at(2);
}

float alpha_at(const AlphaGeometry& geometry, unsigned triangle, Vec2f barycentric) {
    const Scene& scene = *geometry.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(geometry.primitive)];
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    const uint32_t* corners =
        &scene.indices[3 * (static_cast<size_t>(primitive.first_triangle) + triangle)];
    float alpha = material.base_color[3];
    if (primitive.color_base != no_attribute) {
        alpha *= interpolate(scene, corners, primitive.color_base + 3, 4, barycentric);
    }
    const TextureSlot& slot = material.base_color_texture;
    const int32_t uv_base = primitive.uv_base[slot.uv_set];
    if (slot.texture >= 0 && uv_base != no_attribute) {
        const float u = interpolate(scene, corners, uv_base, 2, barycentric);
        const float v = interpolate(scene, corners, uv_base + 1, 2, barycentric);
        const float* m = slot.uv_from_mesh;
        const Vec2f uv{m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]};
        alpha *= sample_texture_bilinear<float>(geometry.textures, slot.texture, uv, 0.0f).alpha;
    }
    return alpha;
}

}  // namespace

bool needs_alpha_filter(const Scene& scene, const Primitive& primitive) {
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    if ((material.flags & (material_alpha_mask | material_alpha_blend)) == 0) return false;
    if (material.base_color[3] < 1.0f || primitive.color_base != no_attribute) return true;
    if ((material.flags & material_alpha_mask) != 0 && material.alpha_cutoff > 1.0f) return true;
    const int32_t texture = material.base_color_texture.texture;
    if (texture < 0) return false;
    const TextureRow& row = scene.textures.rows[static_cast<size_t>(texture)];
    const uint32_t* texels = &scene.textures.texels[static_cast<size_t>(row.level_offset[0])];
    const size_t count = static_cast<size_t>(row.width) * static_cast<size_t>(row.height);
    for (size_t i = 0; i < count; ++i) {
        if (texels[i] >> 24 != 255U) return true;
    }
    return false;
}

void alpha_filter(const RTCFilterFunctionNArguments* args) {
    const auto& geometry = *static_cast<const AlphaGeometry*>(args->geometryUserPtr);
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    const Scene& scene = *geometry.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(geometry.primitive)];
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const unsigned triangle = RTCHitN_primID(args->hit, args->N, i);
        const Vec2f barycentric{RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i)};
        float threshold = material.alpha_cutoff;
        if ((material.flags & material_alpha_blend) != 0) {
            threshold = 0.5f;
            if (!context.fixed_threshold) {
                uint32_t hash = context.keys[RTCRayN_id(args->ray, args->N, i)];
                hash = hash_word(segment_key(hash, context.segment));
                hash = hash_word(hash + RTCHitN_instID(args->hit, args->N, i, 0) * 0x9E3779B9U);
                hash = hash_word(hash ^ (static_cast<uint32_t>(geometry.primitive) * 0x85EBCA6BU));
                hash = hash_word(hash + triangle * 0xC2B2AE35U);
                // In (0, 1]: alpha 0 never hits, alpha 1 always does.
                threshold = unit_float<float>(hash) + 1.0f / 16777216.0f;
            }
        }
        if (alpha_at(geometry, triangle, barycentric) < threshold) args->valid[i] = 0;
    }
}

}  // namespace obscura
