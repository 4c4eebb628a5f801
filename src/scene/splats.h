// scene/splats.h - Gaussian splats in world space: what rays read of them, and their colours.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/unset_array.h"
#include "math/transform.h"
#include "shape/shape_record.h"
#include "shape/splat.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// One primitive of splats, placed by one node.
struct SplatGroup {
    int32_t first = 0;  ///< index of its first splat, which starts a block
    int32_t count = 0;
    int32_t node = -1;          ///< glTF node
    int32_t degree = 0;         ///< of the harmonics, 0 to 3
    bool linear = false;        ///< colours have no sRGB curve
    size_t first_color = 0;     ///< of its first splat, in SplatField::colors
    size_t first_harmonic = 0;  ///< likewise, in SplatField::harmonics
    float harmonic_step = 0;    ///< value of one step of the harmonics' codes
    Affinef object_from_world;  ///< harmonics are seen along directions in the mesh's own space
};

/// All splats of a scene. They are not primitives and have no surface to hit: they attenuate the
/// light that passes through them and add their own.
struct SplatField {
    LargeArray<float> blocks;             ///< see shape/splat.h
    std::vector<ShapeBox> boxes;          ///< around the splats of each block
    std::vector<int32_t> group_of_block;  ///< index in `groups`
    std::vector<SplatGroup> groups;
    // Not read by rays; nodes that show the same primitive share them.
    LargeArray<float> colors;       ///< 3 a splat, as seen from all sides: degree 0 with its 0.5
    LargeArray<int16_t> harmonics;  ///< 3 for each function of degree 1 and above, by splat
    bool empty() const { return groups.empty(); }
};

/// Number of a splat's harmonics above degree 0.
inline constexpr int directional_harmonics(int degree) {
    return (degree + 1) * (degree + 1) - 1;
}

/// The box around the drawn part of a splat; empty where its opacity is too low to be drawn.
///
/// In   world_from_ball: makes the splat of a unit Gaussian
ShapeBox splat_box(const Affined& world_from_ball, double opacity);

/// Writes one splat into its block.
///
/// In      index: index in the field; world_from_ball: not singular
/// Errors  none: a splat that single precision cannot hold gets the opacity 0
void store_splat(const Affined& world_from_ball, float opacity, size_t index, SplatField& field);

/// Colour of a splat in its group's colour space, not below 0, as it is seen along a direction.
///
/// In      direction: in world space, away from the viewer
/// Source  KHR_gaussian_splatting, "Calculating color from Spherical Harmonics"
Vec3f splat_color(const SplatField& field, size_t index, const Vec3f& direction);

size_t splat_bytes(const SplatField& field);

}  // namespace obscura
