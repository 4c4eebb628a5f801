// tests/truth/shapes_test.cpp - rendered analytic shapes: known radiances and tessellated twins.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace shapes_truth {

RenderOptions image(int samples, int strategies = 3) {
    RenderOptions options;
    options.width = 32;
    options.height = 32;
    options.samples_per_pixel = samples;
    options.strategies = strategies;
    return options;
}

Material rough(float color) {
    Material m;
    std::fill_n(m.base_color, 3, color);
    m.metallic = 0;
    m.roughness = 1;
    return m;
}

Material lamp(float radiance) {
    Material m;
    std::fill_n(m.base_color, 3, 0.0F);
    std::fill_n(m.emission, 3, radiance);
    return m;
}

/// Affine map with the columns x, y, z and the translation.
Affined columns(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& t) {
    Affined a;
    const Vec3d all[4] = {x, y, z, t};
    for (int c = 0; c < 4; ++c) {
        a.m[0][c] = all[c].x;
        a.m[1][c] = all[c].y;
        a.m[2][c] = all[c].z;
    }
    return a;
}

/// A lamp above a floor, which a far camera sees in one point.
struct LampCase {
    ShapeRecord shape;
    Affined world;
    const char* name;
};

std::vector<LampCase> lamps() {
    const Vec3d x{1, 0, 0};
    const Vec3d up{0, 1, 0};
    const Vec3d z{0, 0, 1};
    const Affined down = columns(x, -up, -z, {0.5, 1, 0.2});
    const Affined high = columns(x, -up, -z, {0, 30, 0});
    const Affined behind = columns(x, -up, -z, {0.5, 1, -0.6});
    const ShapeRecord moved_sphere =
        scaled_and_moved(make_shape(ShapeKind::sphere, 1), 1, {0.5, 2, -1.1});
    const Affined mirrored = columns(x, -up, z, {0.5, 1, 0.2});
    const Affined sheared = columns(x, -up, z + x * 0.5, {0.5, 1, 0.2});
    return {{make_shape(ShapeKind::sphere, 1), columns(x, up, z, {0.5, 2, -1.1}), "sphere"},
            {moved_sphere, Affined{}, "sphere in the world"},
            {make_shape(ShapeKind::plane, 1, 1.5F), down, "near rectangle"},
            {make_shape(ShapeKind::plane, 1, 1), high, "far rectangle"},
            {make_shape(ShapeKind::plane, 1, 1), mirrored, "mirrored rectangle"},
            {make_shape(ShapeKind::plane, 1, 1), sheared, "parallelogram"},
            {make_shape(ShapeKind::disk, 0.8F), down, "disk"},
            {make_shape(ShapeKind::box, 0.5F, 0.5F, 0.5F), behind, "box"}};
}

double expected_radiance(const LampCase& lamp_case, const Material& ground) {
    const Affined object = inverse(lamp_case.world);
    const auto seen = [&](const Vec3d& wi) {
        // The floor's normal is +Y: its local frame is (z, x, y).
        const Vec3d direction{wi.y, wi.z, wi.x};
        const ShapeRay<double> ray{transform_point(object, Vec3d{0, 0, 0}),
                                   transform_vector(object, direction)};
        const auto roots = intersect_shape<double>(lamp_case.shape, ray);
        return nearest(roots, 1e-9, 1e30).found ? 1.0 : 0.0;
    };
    const Vec3d wo = polar_direction(std::cos(0.3), 0.0);
    const double height = lamp_case.world.m[1][3];
    if (height > 10) {  // too small for the quadrature: area by squared distance
        return evaluate_bsdf(exact_bsdf(ground), wo, {0, 0, 1}).value_cos.x * 4 / (height * height);
    }
    return reflected(exact_bsdf(ground), wo, seen);
}

TEST(ShapeLights, LightAFloorAsTheIntegralOverThem) {
    const Material ground = rough(0.8F);
    const Vec3f eye{0, 1000 * std::cos(0.3F), 1000 * std::sin(0.3F)};
    const Camera camera = look_at(eye, {0, 0, 0}, 4e-5F, 32, 32);
    for (const LampCase& lamp_case : lamps()) {
        const bool far = lamp_case.world.m[1][3] > 10;
        for (const int strategies : {1, 2, 3}) {
            // Lights outside of the light table are found by the BSDF alone, as far lamps hardly
            // are.
            const bool unsampled = lamp_case.shape.kind == static_cast<int32_t>(ShapeKind::box);
            if ((far && strategies == 2) || (unsampled && strategies == 1)) continue;
            SceneBuilder builder;
            builder.quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, builder.material(ground));
            const int32_t light = builder.material(lamp(10));
            Scene scene = builder.take();
            if (std::string(lamp_case.name) == "sphere in the world") {
                add_shape(scene, lamp_case.shape, light);
            } else {
                add_shape(scene, lamp_case.shape, light, lamp_case.world);
            }
            const Mean mean =
                film_mean(render_scene(scene, {}, camera, image(512, strategies)).film);
            const double expected = 10 * expected_radiance(lamp_case, ground);
            EXPECT_NEAR(mean.value, expected, 0.01 * expected + 3 * mean.error)
                << lamp_case.name << ", strategies " << strategies;
        }
    }
}

/// The same sphere as a shape and as a fine mesh, on a floor, under a bright sky.
Scene sphere_scene(bool mesh, const Material& material) {
    SceneBuilder builder;
    const int32_t index = builder.material(material);
    builder.quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}, builder.material(rough(0.5F)));
    if (mesh) builder.sphere({0, 0, 0}, 1, 200, index);
    Scene scene = builder.take();
    if (!mesh) add_shape(scene, make_shape(ShapeKind::sphere, 1), index);
    return scene;
}

TEST(ShapeTwins, SphereLooksLikeItsFineMesh) {
    const Camera camera = look_at({0, 1, 5}, {0, 0, 0}, 0.6F, 32, 32);
    LightingOptions lighting;
    lighting.environment = constant_environment(1.0F);
    Material glossy = rough(0.7F);
    glossy.roughness = 0.3F;
    const Film shape = render_scene(sphere_scene(false, glossy), lighting, camera, image(256)).film;
    const Film mesh = render_scene(sphere_scene(true, glossy), lighting, camera, image(256)).film;
    EXPECT_NEAR(film_mean(shape).value, film_mean(mesh).value, 0.003);
    for (size_t i = 0; i < shape.pixels.size(); ++i)
        ASSERT_NEAR(shape.pixels[i], mesh.pixels[i], 0.08F) << i;
}

TEST(ShapeTwins, AovsAreThoseOfAFineMesh) {
    const Camera camera = look_at({0, 1, 5}, {0, 0, 0}, 0.6F, 32, 32);
    for (const Integrator integrator :
         {Integrator::normal, Integrator::depth, Integrator::albedo}) {
        RenderOptions options = image(1);
        options.integrator = integrator;
        const Film shape = render_scene(sphere_scene(false, rough(0.7F)), {}, camera, options).film;
        const Film mesh = render_scene(sphere_scene(true, rough(0.7F)), {}, camera, options).film;
        int differing = 0;
        for (size_t i = 0; i < shape.pixels.size(); ++i)
            differing += std::fabs(shape.pixels[i] - mesh.pixels[i]) > 2e-3F ? 1 : 0;
        EXPECT_LE(differing, 4) << static_cast<int>(integrator);
    }
}

TEST(ShapeTwins, StretchedAndMirroredInstancesAreEllipsoids) {
    // A sphere by an instance, and the quadric that it becomes, in world space.
    const Affined stretch = columns({1.5, 0, 0}, {0, -0.5, 0}, {0, 0, 0.75}, {0.2, 0.1, 0});
    ShapeRecord quadric = make_shape(ShapeKind::quadric, 2, 2, 2);
    quadric.centre[0] = 0.2F;
    quadric.centre[1] = 0.1F;
    quadric.k[0] = 1 / 2.25F;
    quadric.k[1] = 4;
    quadric.k[2] = 1 / 0.5625F;
    quadric.k[9] = -1;
    const Camera camera = look_at({0, 2, 5}, {0, 0, 0}, 0.7F, 32, 32);
    RenderOptions options = image(1);
    options.integrator = Integrator::normal;
    Scene one = empty_scene(rough(0.5F));
    add_shape(one, make_shape(ShapeKind::sphere, 1), 0, stretch);
    Scene other = empty_scene(rough(0.5F));
    add_shape(other, quadric, 0);
    const Film a = render_scene(one, {}, camera, options).film;
    const Film b = render_scene(other, {}, camera, options).film;
    int lit = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        ASSERT_NEAR(a.pixels[i], b.pixels[i], 1e-3F) << i;
        lit += a.pixels[i] != 0.0F ? 1 : 0;
    }
    EXPECT_GT(lit, 300);
}

TEST(ShapeFurnace, AWhiteSphereVanishesInAWhiteSky) {
    Scene scene = empty_scene(rough(1.0F));
    scene.materials[0].metallic = 1;
    scene.materials[0].roughness = 0;
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    LightingOptions lighting;
    lighting.environment = constant_environment(1.0F);
    const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, 0.6F, 32, 32);
    const Mean mean = film_mean(render_scene(scene, lighting, camera, image(64)).film);
    EXPECT_NEAR(mean.value, 1.0, 0.005);
}

TEST(ShapeFurnace, InsideAGlowingBallEverythingGlows) {
    // Radiance L = 1 + albedo L; a mirror of a light of radiance 1 would never end.
    Material m = lamp(1);
    m.flags |= material_double_sided;
    Scene scene = empty_scene(m);
    add_shape(scene, make_shape(ShapeKind::sphere, 2), 0);
    const Camera camera = look_at({0.5F, 0, 0.3F}, {0, 0, -2}, 1.0F, 32, 32);
    Scene twin = empty_scene(m);
    SceneBuilder builder;
    builder.material(m);
    builder.sphere({0, 0, 0}, 2, 100, 0);
    const Mean shape = film_mean(render_scene(scene, {}, camera, image(256)).film);
    const Mean mesh = film_mean(render_scene(builder.take(), {}, camera, image(256)).film);
    EXPECT_NEAR(shape.value, mesh.value, 0.003 * mesh.value + 3 * (shape.error + mesh.error));
    EXPECT_GT(shape.value, 1.0);
}

TEST(ShapeShadows, RaysFromAShapeNeverMeetItsOwnSurface) {
    // Lit head-on from afar, a convex shape has no shadow on its lit side.
    const ShapeKind kinds[] = {ShapeKind::sphere, ShapeKind::frustum, ShapeKind::capsule};
    for (const ShapeKind kind : kinds) {
        for (const float size : {1e-3F, 1.0F, 1e4F}) {
            for (const bool moved : {false, true}) {
                Scene scene = empty_scene(rough(1.0F));
                const Affined far = columns(
                    {1, 0, 0}, {0, 1.5, 0}, {0, 0, 1}, {0, 0, -8.0 * static_cast<double>(size)});
                const ShapeRecord record = make_shape(kind, size, size, 0.7F * size);
                if (moved) add_shape(scene, record, 0, far);
                if (!moved) add_shape(scene, record, 0);
                PunctualLight sun;
                sun.type = static_cast<int32_t>(PunctualType::directional);
                std::fill_n(sun.intensity, 3, 3.0F);
                scene.lights.push_back(sun);
                const Vec3f target{0, 0, moved ? -8 * size : 0};
                const Camera camera = look_at({0, 0, 6 * size}, target, 0.1F, 32, 32);
                RenderOptions options = image(1);
                options.max_bounces = 0;
                const Film film = render_scene(scene, {}, camera, options).film;
                for (size_t i = 0; i < film.pixels.size(); i += 4)
                    ASSERT_GT(film.pixels[i], 0.05F) << static_cast<int>(kind) << " " << size;
            }
        }
    }
}

}  // namespace shapes_truth
}  // namespace obscura::test
