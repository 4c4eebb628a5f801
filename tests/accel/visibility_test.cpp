// tests/accel/visibility_test.cpp - rays pass the surfaces whose visibility flags they name.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"
#include "accel/ray_recording.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"

namespace obscura {
namespace {

using namespace test;

constexpr uint8_t all_flags[] = {visibility_no_camera, visibility_no_shadow, visibility_catcher};

/// Rays straight down, of which all meet the flagged surface, a plate behind it, or both: 19 are a
/// packet and a part of one.
RayList rays_onto_plates() {
    RayList rays;
    for (int i = 0; i < 19; ++i)
        rays.add({0.05F + 0.05F * static_cast<float>(i), 0.5F, 5}, {0, 0, -1});
    return rays;
}

/// Gives a scene's first surface, above z = 0.5, each flag in turn: only queries that name it pass,
/// and find what lies below, at z = 0.
void expect_first_is_passed(Scene scene, bool instance = false) {
    scene.visibility.primitives.assign(scene.primitives.size(), 0);
    scene.visibility.instances.assign(scene.instances.size(), 0);
    for (const uint8_t flag : all_flags) {
        (instance ? scene.visibility.instances : scene.visibility.primitives).front() = flag;
        const BuiltScene built = build(scene);
        for (const Coherence coherence : both_ways) {
            RayList rays = rays_onto_plates();
            for (const uint8_t passes :
                 {uint8_t{0}, flag, uint8_t{15}, static_cast<uint8_t>(~flag)}) {
                const bool passed = (passes & flag) != 0;
                rays.intersect(built.accel, coherence, {.passes = passes});
                for (int i = 0; i < rays.count(); ++i) {
                    ASSERT_TRUE(rays.hit(i));
                    EXPECT_EQ(rays.t[static_cast<size_t>(i)] > 4.6F, passed) << int{passes};
                }
            }
        }
    }
}

/// A shadow ray meets nothing else there: it arrives if it passes the first surface.
void expect_no_shadow(Scene scene, bool instance = false) {
    scene.visibility.primitives.assign(scene.primitives.size(), 0);
    scene.visibility.instances.assign(scene.instances.size(), 0);
    (instance ? scene.visibility.instances : scene.visibility.primitives).front() =
        visibility_no_shadow;
    const BuiltScene built = build(std::move(scene));
    for (const Coherence coherence : both_ways) {
        for (const uint8_t passes : {uint8_t{0}, uint8_t{visibility_catcher}, shadow_rays_pass}) {
            RayList rays;
            for (int i = 0; i < 19; ++i)
                rays.add({0.05F + 0.05F * static_cast<float>(i), 0.5F, 5}, {0, 0, -1}, 4.8F);
            rays.passes = passes;
            rays.occlude(built.accel, coherence);
            for (int i = 0; i < rays.count(); ++i) {
                EXPECT_EQ(rays.occluded[static_cast<size_t>(i)],
                          passes == shadow_rays_pass ? 0 : 1);
            }
        }
    }
}

SceneBuilder plates() {
    SceneBuilder builder;
    builder.material(Material{});
    builder.quad({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0);
    builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    return builder;
}

ShapeRecord plate_box() {
    ShapeRecord box = make_shape(ShapeKind::box, 1, 1, 0.25F);
    box.centre[0] = 0.5F;
    box.centre[1] = 0.5F;
    box.centre[2] = 1;
    return box;
}

TEST(VisibilityFlags, OfTriangles) {
    expect_first_is_passed(plates().take());
    expect_no_shadow(plates().take());
}

TEST(VisibilityFlags, OfTrianglesWithAlpha) {
    Material blend;
    blend.flags = material_alpha_blend;
    blend.base_color[3] = 1 - 1e-6F;
    SceneBuilder builder;
    builder.material(blend);
    builder.quad({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0);
    builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    expect_first_is_passed(builder.take());
}

TEST(VisibilityFlags, OfShapesAndParticles) {
    Scene boxes = empty_scene({});
    add_shape(boxes, plate_box(), 0);
    ShapeRecord below = plate_box();
    below.centre[2] = -1;
    add_shape(boxes, below, 0);
    expect_first_is_passed(boxes);
    expect_no_shadow(boxes);
    Scene balls = empty_scene({});
    add_spheres(balls, {0.5F, 0.5F, 3, 1}, 0);
    add_shape(balls, below, 0);
    balls.bounds = {{-1, -1, -1}, {4, 4, 4}};
    expect_no_shadow(balls);
}

TEST(VisibilityFlags, OfInfinitePlanes) {
    Scene scene = empty_scene({});
    Affined upright;  // turns the plane's +y to +z, and lifts it
    upright.m[1][1] = upright.m[2][2] = 0;
    upright.m[1][2] = -1;
    upright.m[2][1] = 1;
    upright.m[2][3] = 1;
    add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0, upright);
    upright.m[2][3] = 0;
    add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0, upright);
    expect_first_is_passed(scene, true);
    expect_no_shadow(scene, true);
}

TEST(VisibilityFlags, OfOneInstanceAndNotOfAnother) {
    SceneBuilder builder;
    builder.material(Material{});
    builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    Affined up;
    up.m[2][3] = 1;
    const Scene scene = instanced(builder.take(), {up, Affined{}});
    expect_first_is_passed(scene, true);
    expect_no_shadow(scene, true);
}

TEST(VisibilityFlags, AnUpdateKeepsThem) {
    Scene scene = plates().take();
    scene.visibility.primitives = {visibility_no_camera, 0};
    BuiltScene built = build(scene);
    *built.scene = scene;
    ASSERT_TRUE(built.accel.update(*built.scene));
    RayList rays = rays_onto_plates();
    rays.intersect(built.accel, Coherence::coherent, {.passes = camera_rays_pass});
    EXPECT_FLOAT_EQ(rays.t[0], 5);
}

TEST(VisibilityFlags, ReplayPassesWhatTheRenderingPassed) {
    Scene scene = plates().take();
    scene.visibility.primitives = {visibility_no_camera, visibility_no_camera};
    const BuiltScene built = build(std::move(scene));
    constexpr size_t padded = 32;
    std::vector<float> half(padded, 0.5F), five(padded, 5), zero(padded, 0), down(padded, -1);
    std::vector<uint32_t> key(padded, 0);
    const RayColumns rays{.ox = half.data(),
                          .oy = half.data(),
                          .oz = five.data(),
                          .dx = zero.data(),
                          .dy = zero.data(),
                          .dz = down.data(),
                          .tfar = nullptr,
                          .key = key.data(),
                          .count = 19};
    std::vector<float> t(padded), u(padded), v(padded);
    std::vector<int32_t> instance(padded), primitive(padded), triangle(padded);
    const HitColumns hits{
        t.data(), u.data(), v.data(), instance.data(), primitive.data(), triangle.data()};
    const SeeThrough see_through{.passes = camera_rays_pass};
    built.accel.intersect(rays, hits, Coherence::coherent, see_through);
    RayRecording recording;
    recording.threads.push_back(std::make_unique<RayRecorder>(built.accel.ray_reach()));
    recording.threads.front()->add_hits(rays, hits, see_through);
    EXPECT_EQ(recording.hits(RayKind::camera), 0U);
    for (const ReplayMode mode :
         {ReplayMode::single, ReplayMode::packets, ReplayMode::coherent_packets}) {
        EXPECT_EQ(built.accel.replay(recording, RayKind::camera, mode).hits, 0U);
    }
}

}  // namespace
}  // namespace obscura
