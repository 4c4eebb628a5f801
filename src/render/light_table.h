// render/light_table.h - lists all lights of a scene, with their sampling probabilities.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/cdf_table.h"
#include "light/environment_table.h"
#include "light/light_alpha.h"
#include "light/light_tree.h"
#include "light/light_view.h"
#include "light/shape_light.h"
#include "light/triangle_light.h"
#include "scene/scene.h"

#include <optional>
#include <vector>

namespace obscura {

/// Owns the arrays of LightView.
struct LightTable {
    std::vector<PunctualLight> punctual;
    std::vector<TriangleLight> triangles;
    std::vector<ShapeLight> shapes;
    std::vector<MovingTriangle> moving_triangles;    ///< see LightView
    std::vector<LightAlpha> alphas;                  ///< of triangles and shapes
    const PunctualLight* moving_punctual = nullptr;  ///< of the scene
    LightProfileTable profiles;                      ///< of punctual lights
    std::vector<float> select_pdf;
    std::vector<CdfEntry> choice;
    float environment_select = 0;
    CdfSpread environment_spread;
    LightTree tree;        ///< see LightView
    float tree_share = 0;  ///< probability with which the table chooses it

    LightView view() const;

private:
    LightTreeView tree_view() const;
};

/// Collects the lights and the probabilities of choosing them, in proportion to the power that they
/// send into the scene. Writes Primitive::light_base and Instance::light_base.
///
/// In      environment: null or black: none
LightTable make_light_table(Scene& scene, const EnvironmentTable* environment);

/// The material's emission in its brightest channel, without texture.
float largest_emission(const Material& material);

/// True for materials whose surfaces are lights: all that glow but the unlit ones.
bool emits(const Material& material);

/// True for shadow catchers, which are no lights whatever their material.
bool is_catcher(const Scene& scene, int32_t primitive, int32_t instance);

/// A material's clearcoat factor times the mean of its texture.
float mean_coat(const Scene& scene, const Material& material);

/// Radiance of a light, with its texture, coat and alpha, averaged over the triangle and all
/// directions.
///
/// In      record: of the table
Vec3f mean_emission(const Scene& scene, const LightTable& table, const TriangleLight& record);

/// The maximum over emissive surfaces of the radiance, averaged over area and texture: low if the
/// textures are black but for a few small spots.
double brightest_mean_radiance(const Scene& scene, const LightTable& table);

}  // namespace obscura
