// tests/truth/transparent_shadows_test.cpp - transparent shadows of thin walls, by the formula.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "support/thin_wall_scenes.h"

namespace obscura::test {
namespace transparent_shadows_truth {

/// A lamp that is seen from the origin at an angle of cosine 0.8, above everything.
PunctualLight high_lamp() {
    return lamp_at({6, 8, 0});
}

double lit_by(const PunctualLight& light, ThinWallScene scene, const ThinWallView& view = {}) {
    scene.light(light);
    return floor_value(scene.take(), view);
}

TEST(TransparentShadows, APaneLetsPassWhatItDoesNotReflect) {
    for (const PunctualLight& light : {high_lamp(), slanting_sun()}) {
        const double open = lit_by(light, {});
        ASSERT_GT(open, 0.01);
        ThinWallScene scene;
        scene.pane(2, scene.add(glass_material(), glass_layers()));
        EXPECT_NEAR(lit_by(light, scene) / open, pane_lets_pass(0.8), 1e-5);
        scene.pane(3, 1);
        EXPECT_NEAR(lit_by(light, scene) / open, square(pane_lets_pass(0.8)), 1e-5);
    }
}

TEST(TransparentShadows, SpotAndProfilelessLampsPassAlike) {
    PunctualLight spot = high_lamp();
    spot.type = static_cast<int32_t>(PunctualType::spot);
    spot.direction[0] = -0.6f;
    spot.direction[1] = -0.8f;
    spot.direction[2] = 0;
    const double open = lit_by(spot, {});
    ASSERT_GT(open, 0.01);
    ThinWallScene scene;
    scene.pane(2, scene.add(glass_material(), glass_layers()));
    EXPECT_NEAR(lit_by(spot, scene) / open, pane_lets_pass(0.8), 1e-5);
}

TEST(TransparentShadows, BaseColourMetalAndFactorScaleIt) {
    Material tinted = glass_material();
    tinted.base_color[0] = 0.9f;
    tinted.base_color[1] = 0.5f;
    tinted.base_color[2] = 0.1f;
    tinted.metallic = 0.25f;
    ThinWallScene scene;
    scene.light(slanting_sun());
    const double open = floor_value(scene.take());
    ThinWallScene covered;
    covered.light(slanting_sun());
    covered.pane(2, covered.add(tinted, glass_layers(0.5f)));
    const Film film = floor_film(covered.take());
    const double clear = 0.75 * 0.5 * pane_lets_pass(0.8) * open;
    EXPECT_NEAR(film_mean(film, 0).value, 0.9 * clear, 1e-5 * open);
    EXPECT_NEAR(film_mean(film, 1).value, 0.5 * clear, 1e-5 * open);
    EXPECT_NEAR(film_mean(film, 2).value, 0.1 * clear, 1e-5 * open);
}

/// Half of the pane's texels transmit everything, half a third of it; at the crossing, the first.
TEST(TransparentShadows, TexturesAreReadWhereTheRayCrosses) {
    const auto lit = [](float shift) {
        ThinWallScene covered;
        covered.light(slanting_sun());
        MaterialLayers layers = glass_layers();
        layers.transmission_texture.texture = 0;
        covered.pane(2, covered.add(glass_material(), layers), 4);
        Scene scene = covered.take();
        TextureRecord record;
        record.width = 2;
        record.sampler = pack_sampler(Wrap::clamp, Wrap::clamp, true, true, MipMode::none, false);
        scene.textures.records = {record};
        scene.textures.texels = {0xFF0000FFU, 0xFF000055U};
        // The sun's ray crosses at x = 1.5, where u is 0.6875.
        scene.primitives[1].uv_base[0] = -8;
        scene.attributes = {shift, 0, 1 + shift, 0, 1 + shift, 1, shift, 1, 0, 0, 0, 0};
        return floor_value(std::move(scene));
    };
    ThinWallScene open;
    open.light(slanting_sun());
    const double all = floor_value(open.take()) * pane_lets_pass(0.8);
    EXPECT_NEAR(lit(0) / all, 1.0 / 3, 1e-5);
    EXPECT_NEAR(lit(-0.25f) / all, 1, 1e-5);
}

TEST(TransparentShadows, RoughAndOpaqueThinWallsBlock) {
    Material rough = glass_material();
    rough.roughness = 0.1f;
    ThinWallScene scene;
    scene.pane(2, scene.add(rough, glass_layers()));
    EXPECT_EQ(lit_by(high_lamp(), scene), 0);
    ThinWallScene opaque;
    opaque.pane(2, opaque.add(glass_material(), glass_layers(0)));
    EXPECT_EQ(lit_by(high_lamp(), opaque), 0);
    ThinWallScene behind;
    behind.pane(2, behind.add(glass_material(), glass_layers()));
    behind.pane(3, 0);
    EXPECT_EQ(lit_by(high_lamp(), behind), 0);
    ThinWallScene before;
    before.pane(3, before.add(glass_material(), glass_layers()));
    before.pane(2, 0);
    EXPECT_EQ(lit_by(high_lamp(), before), 0);
}

TEST(TransparentShadows, ALampBetweenPanesIsCoveredByThoseBeforeIt) {
    ThinWallScene scene;
    const int32_t glass = scene.add(glass_material(), glass_layers());
    scene.pane(2, glass);
    scene.pane(9, glass);
    EXPECT_NEAR(lit_by(high_lamp(), scene) / lit_by(high_lamp(), {}), pane_lets_pass(0.8), 1e-5);
}

/// Layers absorb some: transmission is never more than without them.
TEST(TransparentShadows, CoatsReflectFirst) {
    MaterialLayers coated = glass_layers();
    coated.clearcoat = 1;
    ThinWallScene scene;
    scene.pane(2, scene.add(glass_material(), coated));
    const double passed = lit_by(slanting_sun(), scene) / lit_by(slanting_sun(), {});
    // A smooth coat's directional albedo is its Fresnel reflectance: the same term once more.
    EXPECT_NEAR(passed, square(pane_lets_pass(0.8)), 2e-3);
}

/// Coverage of a half: glass where the surface exists.
TEST(TransparentShadows, BlendedThinWallsAreGlassWhereTheyAre) {
    Material veil = glass_material();
    veil.flags |= material_alpha_blend;
    veil.base_color[3] = 0.5f;
    veil.base_color[0] = 0.2f;
    ThinWallScene scene;
    scene.pane(2, scene.add(veil, glass_layers()));
    scene.light(slanting_sun());
    const Mean seen = film_mean(floor_film(scene.take(), {.samples = 256}));
    const double expected = 0.5 + 0.5 * 0.2 * pane_lets_pass(0.8);
    EXPECT_NEAR(seen.value / lit_by(slanting_sun(), {}), expected, 0.01);
}

TEST(TransparentShadows, SoManyPanesAndNoMore) {
    const double open = lit_by(slanting_sun(), {});
    ThinWallScene scene;
    const int32_t glass = scene.add(glass_material(), glass_layers());
    for (int i = 0; i < max_thin_walls; ++i)
        scene.pane(1 + 0.1f * static_cast<float>(i), glass);
    const double expected = std::pow(pane_lets_pass(0.8), max_thin_walls);
    EXPECT_NEAR(lit_by(slanting_sun(), scene) / open, expected, 1e-4 * expected);
    scene.pane(50, glass);
    EXPECT_EQ(lit_by(slanting_sun(), scene), 0);
}

TEST(TransparentShadows, ShapesAndInfinitePlanesAreThinWallsToo) {
    const double open = lit_by(slanting_sun(), {});
    for (const bool infinite : {false, true}) {
        ThinWallScene walls;
        walls.light(slanting_sun());
        const int32_t glass = walls.add(glass_material(), glass_layers());
        Scene scene = walls.take();
        if (infinite) {
            const ShapeRecord plane = make_shape(ShapeKind::plane, unbounded, unbounded);
            add_shape(scene, plane, glass, raised(2));
        } else {  // around the floor: rays from its middle leave at a right angle
            add_shape(scene, make_shape(ShapeKind::sphere, 5), glass);
        }
        const double expected = pane_lets_pass(infinite ? 0.8 : 1.0);
        EXPECT_NEAR(floor_value(std::move(scene)) / open, expected, 1e-4) << infinite;
    }
}

TEST(TransparentShadows, RaycastingPassesLikewise) {
    const ThinWallView view{.integrator = Integrator::raycast};
    const double open = lit_by(slanting_sun(), {}, view);
    ASSERT_GT(open, 0.01);
    ThinWallScene scene;
    scene.pane(2, scene.add(glass_material(), glass_layers()));
    EXPECT_NEAR(lit_by(slanting_sun(), scene, view) / open, pane_lets_pass(0.8), 1e-5);
}

TEST(TransparentShadows, AmbientOcclusionCountsPanesAsWalls) {
    ThinWallScene scene;
    scene.pane(2, scene.add(glass_material(), glass_layers()), 1000);
    EXPECT_LT(lit_by(slanting_sun(), scene, {.integrator = Integrator::ao}), 0.01);
}

}  // namespace transparent_shadows_truth
}  // namespace obscura::test
