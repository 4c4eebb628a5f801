// tests/accel/list_surfaces_test.cpp - all surfaces that rays meet, in packets.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace obscura::test {
namespace {

using Surfaces = std::vector<std::set<std::pair<int32_t, int32_t>>>;  // by ray

/// Every surface bounds a medium, so that queries of single rays for media find them all.
Scene media_everywhere(Scene scene) {
    for (Material& material : scene.materials)
        material.layers = 0;
    scene.layers.resize(1);
    scene.layers[0].medium = 1;
    scene.media.resize(2);
    return scene;
}

/// Squares above each other, some of which are seen from below only.
SceneBuilder squares() {
    SceneBuilder builder;
    builder.material({});
    for (int i = 0; i < 6; ++i) {
        const Vec3f corner{-2 + 0.3F * static_cast<float>(i), -2, 0.7F * static_cast<float>(i)};
        if (i % 2 == 0) {
            builder.quad(corner, {3, 0, 0.2F}, {0, 3, 0}, 0);
        } else {
            builder.quad(corner, {0, 3, 0}, {3, 0, 0.2F}, 0);
        }
    }
    return builder;
}

/// Rays through the space around the origin, not of whole packets; one in thirteen is unsafe.
RayList rays_through_all() {
    constexpr int count = 1003;
    Pcg32 random(7);
    RayList rays;
    for (int i = 0; i < count; ++i) {
        const Vec3f from = random_unit(random) * 8.0F;
        const Vec3f to = random_in_cube(random, 2) + Vec3f{0, 0, 1.5F};
        const float bad = i % 13 == 5 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
        const float end = i % 7 == 0 ? 8.0F : unlimited;
        rays.add(from + Vec3f{bad, 0, 0}, normalize(to - from), end);
    }
    return rays;
}

void expect_all_are_listed(const Scene& scene) {
    const BuiltScene built = build(media_everywhere(scene));
    RayList rays = rays_through_all();
    for (const bool culls : {false, true}) {
        const SeeThrough see_through{.culls_back_faces = culls, .fixed_alpha = true};
        Surfaces expected(static_cast<size_t>(rays.count()));
        size_t all = 0;
        for (int i = 0; i < rays.count(); ++i) {
            auto& surfaces = expected[static_cast<size_t>(i)];
            for (const Crossing& met : rays.list_crossings(built.accel, i, see_through))
                surfaces.insert({met.surface.instance, met.surface.primitive});
            all += surfaces.size();
        }
        EXPECT_GT(all, 300U);
        for (const Coherence coherence : both_ways) {
            Surfaces found(expected.size());
            for (const MetSurface& met : rays.list_surfaces(built.accel, coherence, see_through)) {
                ASSERT_TRUE(met.index >= 0 && met.index < rays.count());
                found[static_cast<size_t>(met.index)].insert(
                    {met.surface.instance, met.surface.primitive});
            }
            EXPECT_EQ(found, expected) << culls;
        }
    }
}

TEST(ListSurfaces, ASceneCountedByHand) {
    Scene scene = squares().take();
    scene.materials[0].flags &= ~material_double_sided;
    add_shape(
        scene, make_shape(ShapeKind::sphere, 0.25F), 0);  // inside of the second square's height
    const BuiltScene built = build(std::move(scene));
    RayList rays;
    rays.add({0, 0, 9}, {0, 0, -1});     // down: the squares that face up, and the sphere
    rays.add({0, 0, 9}, {0, 0, -1}, 6);  // ends at z = 3
    rays.add({0.9F, 0, -9}, {0, 0, 1});  // up, past the sphere: the others
    rays.add({50, 0, 9}, {0, 0, -1});    // past all
    std::vector<std::set<int32_t>> found(4);
    const SeeThrough see_through{.culls_back_faces = true};
    for (const MetSurface& met :
         rays.list_surfaces(built.accel, Coherence::incoherent, see_through)) {
        EXPECT_EQ(met.surface.instance, -1);
        found[static_cast<size_t>(met.index)].insert(met.surface.primitive);
    }
    using Found = std::set<int32_t>;
    EXPECT_EQ(found[0], (Found{0, 2, 4, 6}));
    EXPECT_EQ(found[1], (Found{}));
    EXPECT_EQ(found[2], (Found{1, 3, 5}));
    EXPECT_EQ(found[3], (Found{}));
}

TEST(ListSurfaces, Triangles) {
    expect_all_are_listed(squares().take());
}

TEST(ListSurfaces, MirroredAndTurnedInstances) {
    expect_all_are_listed(instanced(
        squares().take(), {scaling(-1, 1, 1), scaling(1, 1, -1, {1, 1, -2}), scaling(1, 2, 1)}));
}

TEST(ListSurfaces, AnalyticShapesParticlesAndPlanes) {
    Scene scene = squares().take();
    add_shape(scene, make_shape(ShapeKind::box, 1, 1, 2), 0);
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0, scaling(-2, 2, 2));
    add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0);
    std::vector<float> spheres;
    for (int i = 0; i < 70; ++i) {
        const auto number = static_cast<float>(i);
        spheres.insert(spheres.end(), {std::sin(number), std::cos(number), 0.05F * number, 0.1F});
    }
    add_spheres(scene, spheres, 0);
    expect_all_are_listed(scene);
}

TEST(ListSurfaces, AbsentSurfacesAreNotListed) {
    Scene scene = squares().take();
    scene.visibility.primitives.assign(scene.primitives.size(), visibility_catcher);
    const BuiltScene built = build(std::move(scene));
    RayList rays = rays_through_all();
    EXPECT_FALSE(rays.list_surfaces(built.accel, Coherence::coherent).empty());
    EXPECT_TRUE(rays.list_surfaces(built.accel, Coherence::coherent, {.passes = visibility_catcher})
                    .empty());
}

}  // namespace
}  // namespace obscura::test
