// tests/truth/aovs_test.cpp - AOVs: facing, distance, uv and heat against closed forms.
// SPDX-License-Identifier: Apache-2.0
#include "camera/camera_models.h"
#include "camera/closed_rays.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"

namespace obscura::test {
namespace aovs_truth {

constexpr int width = 64;
constexpr int height = 48;

RenderOptions options_for(Integrator integrator) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.integrator = integrator;
    return options;
}

Material double_sided() {
    Material m;
    m.flags = material_double_sided;
    return m;
}

/// First hit of a pixel's centre ray on a ball and on the large ball around everything.
struct BallHit {
    double t = INFINITY;
    double facing = 0;
};

void meet(const ClosedRay& ray, const Vec3d& centre, double radius, BallHit& hit) {
    const Vec3d from = ray.origin - centre;
    const double b = dot(from, ray.direction);
    const double discriminant = b * b - dot(from, from) + radius * radius;
    if (discriminant < 0) return;
    for (const double t : {-b - std::sqrt(discriminant), -b + std::sqrt(discriminant)}) {
        if (t <= 0 || t >= hit.t) continue;
        const Vec3d normal = (from + ray.direction * t) * (1 / radius);
        hit = {t, std::fabs(dot(normal, ray.direction))};
    }
}

/// The memory of an earlier film, of any size and content, changes nothing.
TEST(Aovs, FilmsAreWrittenIntoOldMemory) {
    Scene scene = empty_scene(double_sided());
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    const Camera camera = look_at({0, 0, 4}, {0, 0, 0}, 0.8f, width, height);
    for (const Integrator integrator : {Integrator::distance, Integrator::path}) {
        for (const bool cropped : {false, true}) {
            RenderOptions options = options_for(integrator);
            options.samples_per_pixel = 2;
            if (cropped) options.crop = PixelRect{10, 5, 30, 20};
            const Film fresh = render_scene(scene, {}, camera, options).film;
            for (const size_t old : {size_t{7}, fresh.pixels.size(), 3 * fresh.pixels.size()}) {
                UnsetArray<float> memory(old, NAN);
                options.film_memory = &memory;
                const Film film = render_scene(scene, {}, camera, options).film;
                EXPECT_EQ(film.pixels, fresh.pixels) << old << ", cropped " << cropped;
            }
        }
    }
}

TEST(Aovs, DistanceAndFacingOfBallsInEveryCamera) {
    for (const NamedCamera& named : all_cameras()) {
        const Affinef& place = named.camera.world_from_camera;
        const Vec3f ahead = transform_point(place, Vec3f{0.4f, -0.3f, -5});
        const Vec3f around = transform_point(place, Vec3f{0, 0, 0});
        Scene scene = empty_scene(double_sided());
        for (const auto& [centre, radius] : {std::pair{ahead, 1.5f}, std::pair{around, 20.0f}}) {
            ShapeRecord record = make_shape(ShapeKind::sphere, radius);
            record.centre[0] = centre.x;
            record.centre[1] = centre.y;
            record.centre[2] = centre.z;
            add_shape(scene, record, 0);
        }
        const Film distance =
            render_scene(scene, {}, named.camera, options_for(Integrator::distance)).film;
        const Film facing =
            render_scene(scene, {}, named.camera, options_for(Integrator::facing)).film;
        EXPECT_EQ(distance.channels, (std::vector<std::string>{"distance"}));
        EXPECT_EQ(facing.channels, (std::vector<std::string>{"facing"}));
        for (int i = 0; i < width * height; ++i) {
            const ClosedRay ray = closed_ray(named.camera, {i % width, i / width, width, height});
            BallHit hit;
            meet(ray, widen(ahead), 1.5, hit);
            const double edge = hit.facing;  // at the silhouette rounding decides
            meet(ray, widen(around), 20, hit);
            if (!ray.seen || (hit.facing == edge && edge < 0.02)) continue;
            const auto at = static_cast<size_t>(i);
            ASSERT_NEAR(distance.pixels[at], hit.t, 3e-5 * hit.t) << named.name << " " << i;
            ASSERT_NEAR(facing.pixels[at], hit.facing, 5e-4) << named.name << " " << i;
        }
    }
}

TEST(Aovs, DistanceCountsFromTheEyeWhateverIsHidden) {
    Scene scene = empty_scene(double_sided());
    add_shape(scene, make_shape(ShapeKind::sphere, 20), 0);
    for (NamedCamera& named : all_cameras()) {
        named.camera.world_from_camera = {};
        if (named.camera.model == CameraModel::orthographic) continue;
        named.camera.near_m = 3;
        const Film film =
            render_scene(scene, {}, named.camera, options_for(Integrator::distance)).film;
        // Two eyes stand 3 cm beside the middle; what a fisheye cannot show is 0.
        for (const float d : film.pixels)
            ASSERT_TRUE(d == 0 || std::fabs(d - 20) < 0.031f) << named.name << " " << d;
        EXPECT_GT(*std::max_element(film.pixels.begin(), film.pixels.end()), 19) << named.name;
    }
}

TEST(Aovs, UvIsTheInterpolatedAttribute) {
    SceneBuilder builder;
    const int32_t index = builder.material(double_sided());
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, index);
    builder.quad({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}, index);  // without coordinates
    // At (x, y): u = 1.5 + x, v = -0.25 - 0.5 y
    builder.scene().primitives[0].uv_base[0] = 0;
    builder.scene().attributes = {0.5f, 0.25f, 2.5f, 0.25f, 2.5f, -0.75f, 0.5f, -0.75f};
    builder.scene().attributes.resize(12);
    const Scene scene = builder.take();
    const Camera camera = look_at({1, 2, 4}, {0, 0, 0}, 0.7f, width, height);
    const Film film = render_scene(scene, {}, camera, options_for(Integrator::uv)).film;
    EXPECT_EQ(film.channels, (std::vector<std::string>{"UV.U", "UV.V"}));
    int inside = 0;
    for (int i = 0; i < width * height; ++i) {
        const ClosedRay ray = closed_ray(camera, {i % width, i / width, width, height});
        const Vec3d p = ray.origin + ray.direction * (-ray.origin.z / ray.direction.z);
        const double out = std::max(std::fabs(p.x), std::fabs(p.y)) - 1;
        if (std::fabs(out) < 1e-5) continue;
        inside += out < 0 ? 1 : 0;
        const float* uv = &film.pixels[2 * static_cast<size_t>(i)];
        ASSERT_NEAR(uv[0], out < 0 ? 1.5 + p.x : 0, 2e-6) << i;
        ASSERT_NEAR(uv[1], out < 0 ? -0.25 - 0.5 * p.y : 0, 2e-6) << i;
    }
    EXPECT_GT(inside, 300);
}

TEST(Aovs, UvOfAShapeIsItsParametrisation) {
    Scene scene = empty_scene(double_sided());
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    const Camera camera = look_at({0.5f, 1, 4}, {0, 0, 0}, 0.6f, width, height);
    const Film film = render_scene(scene, {}, camera, options_for(Integrator::uv)).film;
    int inside = 0;
    for (int i = 0; i < width * height; ++i) {
        const ClosedRay ray = closed_ray(camera, {i % width, i / width, width, height});
        BallHit hit;
        meet(ray, {0, 0, 0}, 1, hit);
        if (hit.facing < 0.05) continue;
        ++inside;
        const Vec3d n = ray.origin + ray.direction * hit.t;
        const float* uv = &film.pixels[2 * static_cast<size_t>(i)];
        ASSERT_NEAR(uv[0], std::atan2(n.x, n.z) / (2 * pi_d) + 0.5, 2e-5) << i;
        ASSERT_NEAR(uv[1], std::acos(n.y) / pi_d, 2e-5) << i;
    }
    EXPECT_GT(inside, 300);
}

TEST(Aovs, HeatIsTheNumberOfTests) {
    // Three parallel sheets one behind the other; a pixel beside them tests nothing.
    SceneBuilder builder;
    const int32_t index = builder.material(double_sided());
    for (const float z : {0.0f, -1.0f, -2.0f})
        builder.quad({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, index);
    const Scene scene = builder.take();
    const Camera camera = look_at({0, 0, 100}, {0, 0, 0}, 0.04f, width, height);
    const Film film = render_scene(scene, {}, camera, options_for(Integrator::heat)).film;
    EXPECT_EQ(film.channels, (std::vector<std::string>{"heat"}));
    for (int i = 0; i < width * height; ++i) {
        const ClosedRay ray = closed_ray(camera, {i % width, i / width, width, height});
        const Vec3d p = ray.origin + ray.direction * (-ray.origin.z / ray.direction.z);
        const bool inside = std::max(std::fabs(p.x), std::fabs(p.y)) < 0.99;
        const bool outside = std::max(std::fabs(p.x), std::fabs(p.y)) > 1.05;
        const float tests = film.pixels[static_cast<size_t>(i)];
        // The two triangles of a sheet have the same box; the sheets behind are never asked.
        ASSERT_TRUE(!inside || tests == 1 || tests == 2) << i;
        ASSERT_TRUE(!outside || tests == 0) << i;
    }
}

}  // namespace aovs_truth
}  // namespace obscura::test
