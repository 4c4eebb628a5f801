// tests/accel/thin_wall_test.cpp - occlusion behind surfaces that may be thin walls.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"

namespace obscura {
namespace {

using namespace test;

/// Record 0 is opaque, record 1 clear glass without thickness.
SceneBuilder glass_and_stone() {
    SceneBuilder builder;
    builder.material(Material{});
    Material glass;
    glass.metallic = 0;
    glass.roughness = 0;
    glass.layers = 0;
    builder.material(glass);
    MaterialLayers layers;
    layers.transmission = 1;
    builder.scene().layers = {layers};
    return builder;
}

/// Straight down at x = 0.5, 1.5 and 2.5.
RayList three_rays() {
    RayList rays;
    for (int i = 0; i < 3; ++i)
        rays.add({0.5F + static_cast<float>(i), 0.5F, 5}, {0, 0, -1});
    return rays;
}

/// Glass is below the first two rays, stone below the second.
void expect_first_passes(const Accel& accel) {
    EXPECT_TRUE(accel.has_thin_walls());
    for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
        RayList rays = three_rays();
        rays.occlude(accel, coherence, 0, true);
        EXPECT_EQ(rays.occluded[0], 0);
        EXPECT_EQ(rays.thin_walls[0], 1);
        EXPECT_EQ(rays.occluded[1], 1);
        EXPECT_EQ(rays.occluded[2], 0);
        EXPECT_EQ(rays.thin_walls[2], 0);
        rays.occlude(accel, coherence);
        EXPECT_EQ(rays.occluded[0], 1);
        EXPECT_EQ(rays.thin_walls[0], 0);
        EXPECT_EQ(rays.occluded[2], 0);
        rays.intersect(accel, coherence);
        EXPECT_TRUE(rays.hit(0));
    }
}

TEST(ThinWallsInTheWay, OfTriangles) {
    SceneBuilder builder = glass_and_stone();
    builder.quad({0, 0, 1}, {2, 0, 0}, {0, 1, 0}, 1);
    builder.quad({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    expect_first_passes(build(builder.take()).accel);
}

TEST(ThinWallsInTheWay, OfShapes) {
    SceneBuilder builder = glass_and_stone();
    builder.quad({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    Scene scene = builder.take();
    ShapeRecord box = make_shape(ShapeKind::box, 1, 0.5F, 0.25F);
    box.centre[0] = 1;
    box.centre[1] = 0.5F;
    box.centre[2] = 2;
    add_shape(scene, box, 1);
    expect_first_passes(build(std::move(scene)).accel);
}

TEST(ThinWallsInTheWay, OfParticles) {
    SceneBuilder builder = glass_and_stone();
    builder.quad({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    Scene scene = builder.take();
    add_spheres(scene, {0.5F, 0.5F, 2, 0.4F, 1.5F, 0.5F, 2, 0.4F}, 1);
    expect_first_passes(build(std::move(scene)).accel);
}

TEST(ThinWallsInTheWay, NoneWhereGlassIsRoughOrHasAVolume) {
    for (const bool rough : {false, true}) {
        SceneBuilder builder = glass_and_stone();
        builder.quad({0, 0, 1}, {2, 0, 0}, {0, 1, 0}, 1);
        Scene scene = builder.take();
        if (rough) scene.materials[1].roughness = 0.1F;
        if (!rough) scene.layers[0].medium = 1;
        const BuiltScene built = build(std::move(scene));
        EXPECT_FALSE(built.accel.has_thin_walls());
        RayList rays = three_rays();
        rays.occlude(built.accel, Coherence::incoherent, 0, true);
        EXPECT_EQ(rays.occluded[0], 1);
    }
}

/// A cut at one half: where alpha cuts out, there is no wall.
TEST(ThinWallsInTheWay, AlphaIsAskedFirst) {
    for (const float alpha : {0.4F, 0.6F}) {
        SceneBuilder builder = glass_and_stone();
        builder.quad({0, 0, 1}, {2, 0, 0}, {0, 1, 0}, 1);
        Scene scene = builder.take();
        scene.materials[1].flags |= material_alpha_mask;
        scene.materials[1].base_color[3] = alpha;
        const BuiltScene built = build(std::move(scene));
        RayList rays = three_rays();
        rays.occlude(built.accel, Coherence::incoherent, 0, true);
        EXPECT_EQ(rays.occluded[0], 0);
        EXPECT_EQ(rays.thin_walls[0], alpha > 0.5F ? 1 : 0);
    }
}

}  // namespace
}  // namespace obscura
