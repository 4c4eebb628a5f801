// render/light_alphas.cpp - the alpha of emitters, for the light table.
// SPDX-License-Identifier: Apache-2.0
#include "render/light_alphas.h"

#include "light/triangle_light.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// A hole may be all that the look-ups for the mean find: what varies keeps a little of its power.
constexpr float min_mean = 1e-3f;

/// Look-ups for the mean, along a side of the square that they are spread over.
constexpr int mean_side = 8;

void set_mode(const Material& material, LightAlpha& out) {
    out.is_mask = (material.flags & material_alpha_blend) != 0 ? 0 : 1;
    out.cutoff = material.alpha_cutoff;
}

/// Mean over the surface, whose points `weight` maps from the unit square.
template <typename Map>
void set_mean(const Scene& scene, const Map& weight, LightAlpha& out) {
    const TextureView textures = view_of(scene.textures);
    const LightAlphaValues<float> values = spread<float>(out);
    float sum = 0;
    for (int i = 0; i < mean_side * mean_side; ++i) {
        const int row = i / mean_side;
        const Vec2f u{(static_cast<float>(i % mean_side) + 0.5f) / mean_side,
                      (static_cast<float>(row) + 0.5f) / mean_side};
        sum += light_alpha<float>(textures, values, weight(u));
    }
    out.mean = std::max(sum / (mean_side * mean_side), min_mean);
}

/// The same where alpha is one number; nothing if that is opaque.
std::optional<LightAlpha> uniform(LightAlpha out) {
    const float alpha = out.factor[0];
    const float kept = alpha >= out.cutoff ? 1.0f : 0.0f;
    out.mean = out.is_mask != 0 ? kept : std::clamp(alpha, 0.0f, 1.0f);
    if (out.mean >= 1) return std::nullopt;
    return out;
}

}  // namespace

bool has_alpha(const Material& material) {
    return (material.flags & (material_alpha_mask | material_alpha_blend)) != 0;
}

Vec2f texture_corner(const Scene& scene,
                     const Primitive& primitive,
                     const TextureSlot& slot,
                     uint32_t vertex) {
    const int32_t base = primitive.uv_base[slot.uv_set];
    if (base == no_attribute) return {0, 0};
    const auto word = static_cast<size_t>(base + static_cast<int64_t>(vertex) * 2);
    const float u = scene.attributes[word];
    const float v = scene.attributes[word + 1];
    const float* m = slot.uv_from_mesh;
    return {m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]};
}

std::optional<LightAlpha> triangle_alpha(const Scene& scene,
                                         const Primitive& primitive,
                                         const std::array<uint32_t, 3>& corners) {
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    LightAlpha out;
    set_mode(material, out);
    float* const uv[3] = {out.uv0, out.uv1, out.uv2};
    const TextureSlot& slot = material.base_color_texture;
    const bool has_uv = primitive.uv_base[slot.uv_set] != no_attribute;
    out.texture = has_uv ? slot.texture : -1;
    for (size_t k = 0; k < 3; ++k) {
        out.factor[k] = material.base_color[3];
        if (primitive.color_base != no_attribute) {
            const int64_t word = primitive.color_base + static_cast<int64_t>(corners[k]) * 4 + 3;
            out.factor[k] *= scene.attributes[static_cast<size_t>(word)];
        }
        if (out.texture < 0) continue;
        const Vec2f corner = texture_corner(scene, primitive, slot, corners[k]);
        uv[k][0] = corner.x;
        uv[k][1] = corner.y;
    }
    const bool varies = out.factor[0] != out.factor[1] || out.factor[0] != out.factor[2];
    if (out.texture < 0 && !varies) return uniform(out);
    set_mean(
        scene, [](const Vec2f& u) { return triangle_from_square(u); }, out);
    return out;
}

std::optional<LightAlpha> shape_alpha(const Scene& scene, const Material& material, bool sphere) {
    LightAlpha out;
    set_mode(material, out);
    std::fill_n(out.factor, 3, material.base_color[3]);
    out.texture = material.base_color_texture.texture;
    if (out.texture < 0) return uniform(out);
    const float* m = material.base_color_texture.uv_from_mesh;
    for (int row = 0; row < 2; ++row) {
        out.uv0[row] = m[3 * row + 2];
        out.uv1[row] = m[3 * row] + m[3 * row + 2];
        out.uv2[row] = m[3 * row + 1] + m[3 * row + 2];
    }
    // Of a sphere, equal steps of height have equal areas.
    const auto polar = [](float height) { return std::acos(1 - 2 * height) * (1 / pi_f); };
    set_mean(
        scene,
        [&](const Vec2f& u) {
            return Vec2f{u.x, sphere ? polar(u.y) : u.y};
        },
        out);
    return out;
}

float mean_alpha(std::span<const LightAlpha> alphas, int32_t alpha) {
    return alpha < 0 ? 1.0f : alphas[static_cast<size_t>(alpha)].mean;
}

}  // namespace obscura
