// render/light_alphas.h - the alpha of emitters, for the light table.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/light_alpha.h"
#include "scene/scene.h"

#include <array>
#include <optional>
#include <span>

namespace obscura {

/// True for materials with alpha MASK or BLEND.
bool has_alpha(const Material& material);

/// A vertex's coordinates in a texture, its transform included; 0, 0 without coordinates.
Vec2f texture_corner(const Scene& scene,
                     const Primitive& primitive,
                     const TextureSlot& slot,
                     uint32_t vertex);

/// The alpha of a triangle, of a material that has_alpha; nothing where it is opaque throughout.
///
/// In      corners: vertices, in the order of the light's corners
std::optional<LightAlpha> triangle_alpha(const Scene& scene,
                                         const Primitive& primitive,
                                         const std::array<uint32_t, 3>& corners);

/// The same of an analytic shape. sphere: its texture coordinates are those of a sphere.
std::optional<LightAlpha> shape_alpha(const Scene& scene, const Material& material, bool sphere);

/// Mean of what a light lets out.
///
/// In      alpha: TriangleLight::alpha or ShapeLight::alpha
float mean_alpha(std::span<const LightAlpha> alphas, int32_t alpha);

}  // namespace obscura
