// light/light_view.h - all lights of a scene in one numbered list, as raw pointers for gathers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/cdf_table.h"
#include "light/light_profile.h"
#include "light/light_tree.h"

#include <cstdint>

namespace obscura {

struct LightAlpha;
struct MovingTriangle;
struct PunctualLight;
struct ShapeLight;
struct TriangleLight;

/// Lights are numbered: punctual ones first, then emissive triangles, then emissive shapes, then
/// the environment.
struct LightView {
    /// Chooses a light, or the tree: the entry after those of all lights. Lights of the tree are
    /// not chosen by the table.
    const CdfEntry* choice = nullptr;
    const float* select_pdf = nullptr;  ///< by light number: probability; 1 for lights of the tree
    int32_t count = 0;                  ///< of all lights
    int32_t punctual_count = 0;
    int32_t triangle_count = 0;
    const PunctualLight* punctual = nullptr;
    const TriangleLight* triangles = nullptr;
    int32_t shape_count = 0;
    const ShapeLight* shapes = nullptr;
    float environment_select = 0;  ///< probability of choosing the environment
    CdfSpread environment_spread;  ///< of the random numbers that choose it
    LightProfileView profiles;     ///< of punctual lights
    /// Lights at each of MotionView::steps times: `steps` records for every punctual light, and for
    /// every triangle that moves. Null: nothing moves.
    const PunctualLight* moving_punctual = nullptr;
    const MovingTriangle* moving_triangles = nullptr;
    const LightAlpha* alphas = nullptr;  ///< of triangles and shapes; null: all are opaque
    LightTreeView tree;                  ///< chooses among many lights with a place
};

}  // namespace obscura
