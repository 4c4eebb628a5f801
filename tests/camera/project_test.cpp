// tests/camera/project_test.cpp - points on a ray project back to the ray's pixel, in every model.
// SPDX-License-Identifier: Apache-2.0
#include "camera/project.h"

#include "camera/camera_models.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/random.h"

namespace obscura::test {
namespace {

template <typename F>
FilmPoint<F> centre_of_lens(const F& x, const F& y) {
    return {{x, y}, {x, y}, {F(0.5f), F(0.5f)}};
}

/// Without the right eye's half, because project() answers for the left eye.
Vec2<double> some_film_point(const Camera& camera, Pcg32& random) {
    const double height = camera.environment.half_eyes_m > 0 ? 0.49 : 1;
    return {static_cast<double>(random.next_float()),
            height * static_cast<double>(random.next_float())};
}

TEST(Project, FindsTheFilmPointOfEveryRayWithinATenThousandthPixel) {
    for (const auto& [name, camera] : all_cameras()) {
        SCOPED_TRACE(name);
        Pcg32 random(1);
        int seen = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec2<double> film = some_film_point(camera, random);
            const CameraRay<double> ray = generate_ray(camera, film);
            if (!ray.valid) continue;
            ++seen;
            const double distance = 1 + 9 * static_cast<double>(random.next_float());
            const auto got = project(camera, ray.origin + distance * ray.direction);
            ASSERT_TRUE(got) << film.x << " " << film.y;
            const double across = got->x - film.x;
            // The left and right edge of an image of all directions are one.
            const double turned = std::abs(across - std::round(across));
            const bool round = camera.model == CameraModel::environment;
            EXPECT_LT((round ? turned : std::abs(across)) * film_width, 1e-4) << film.x;
            EXPECT_LT(std::abs(got->y - film.y) * film_height, 1e-4) << film.y;
        }
        EXPECT_GT(seen, 1500);
    }
}

TEST(Project, RaysOfFloatsStayNearThoseOfDoubles) {
    for (const auto& [name, camera] : all_cameras()) {
        SCOPED_TRACE(name);
        Pcg32 random(2);
        for (int i = 0; i < 4000; ++i) {
            const Vec2<double> film = some_film_point(camera, random);
            const auto x = static_cast<float>(film.x);
            const auto y = static_cast<float>(film.y);
            const CameraRay<float> ray = generate_ray(camera, Vec2<float>{x, y});
            const CameraRay<double> truth = generate_ray(camera, Vec2<double>{x, y});
            EXPECT_TRUE(std::isfinite(ray.direction.x + ray.direction.y + ray.direction.z));
            EXPECT_NEAR(length(ray.direction), 1.0f, 1e-5f);
            if (!ray.valid || !truth.valid) continue;
            // At the end of the law the angle is most sensitive to its radius.
            const bool steep = truth.cone_spread > 4 * camera.fisheye.pixel_spread &&
                               camera.model == CameraModel::fisheye;
            EXPECT_LT(length(widen(ray.direction) - truth.direction), steep ? 1e-4 : 2e-6);
            EXPECT_LT(length(widen(ray.origin) - truth.origin), 4e-6);
        }
    }
}

/// Lanes run the same formula; only the elementary functions may differ by a few units.
TEST(Project, LanesMatchSingleRays) {
    for (const auto& [name, camera] : all_cameras()) {
        SCOPED_TRACE(name);
        Pcg32 random(3);
        float xs[lane_count];
        float ys[lane_count];
        for (int i = 0; i < lane_count; ++i) {
            xs[i] = random.next_float();
            ys[i] = random.next_float();
        }
        const CameraRay<Lanes> rays =
            generate_ray(camera, centre_of_lens(load(xs), load(ys)), false);
        float d[3][lane_count];
        store(d[0], rays.direction.x);
        store(d[1], rays.direction.y);
        store(d[2], rays.direction.z);
        for (int i = 0; i < lane_count; ++i) {
            const CameraRay<float> ray = generate_ray(camera, Vec2<float>{xs[i], ys[i]});
            EXPECT_EQ((mask_bits(rays.valid) >> i & 1U) != 0, ray.valid);
            EXPECT_NEAR(d[0][i], ray.direction.x, 2e-6f);
            EXPECT_NEAR(d[1][i], ray.direction.y, 2e-6f);
            EXPECT_NEAR(d[2][i], ray.direction.z, 2e-6f);
        }
    }
}

TEST(Project, NothingIsSeenBehindAFlatFilmOrOutsideACircle) {
    Camera camera = pinhole_camera();
    camera.world_from_camera = {};
    EXPECT_FALSE(project(camera, {0, 0, 1}));
    Camera fisheye = fisheye_camera(FisheyeLaw::equidistant, 200, no_k);
    fisheye.world_from_camera = {};
    EXPECT_TRUE(project(fisheye, {1, 0, 0.1}));
    EXPECT_FALSE(project(fisheye, {1, 0, 1}));
    EXPECT_FALSE(generate_ray(fisheye, Vec2<double>{0.01, 0.5}).valid);
    EXPECT_TRUE(generate_ray(fisheye, Vec2<double>{0.5, 0.001}).valid);
}

/// One pixel away, the ray moves by one footprint, within a factor that filtering tolerates.
TEST(Project, AFootprintIsAboutOnePixel) {
    for (const auto& [name, camera] : all_cameras()) {
        SCOPED_TRACE(name);
        Pcg32 random(4);
        for (int i = 0; i < 200; ++i) {
            const Vec2<double> film{0.2 + 0.6 * static_cast<double>(random.next_float()),
                                    0.2 + 0.25 * static_cast<double>(random.next_float())};
            const CameraRay<double> a = generate_ray(camera, film);
            const CameraRay<double> b =
                generate_ray(camera, Vec2<double>{film.x, film.y + 1.0 / film_height});
            if (!a.valid || !b.valid) continue;
            const double far = 10;
            const double apart =
                length(a.origin + far * a.direction - b.origin - far * b.direction);
            const double footprint = a.cone_width + far * a.cone_spread;
            EXPECT_GT(footprint, 0.4 * apart);
            EXPECT_LT(footprint, 6 * apart);
        }
    }
}

TEST(Clipping, RaysBeginAtTheNearDistanceAndEndAtTheFarOne) {
    for (auto [name, camera] : all_cameras()) {
        SCOPED_TRACE(name);
        const Vec2<double> film{0.4, 0.3};
        const FilmPoint<double> point{film, film, {0.5, 0.5}};
        const CameraRay<double> whole = generate_ray(camera, film);
        camera.near_m = 2;
        camera.far_m = 5;
        EXPECT_TRUE(limits_rays(camera));
        visit_model(camera, false, [&, &lens = camera](auto maker) {
            const WorldRay<double> made = world_ray<decltype(maker)>(lens, point);
            const CameraRay<double>& ray = made.ray;
            const double skipped = dot(ray.origin - whole.origin, whole.direction);
            const auto& m = lens.world_from_camera.m;
            const Vec3d forward{-m[0][2], -m[1][2], -m[2][2]};
            const double along = measures_from_eye(lens.model) ? 1 : dot(whole.direction, forward);
            EXPECT_NEAR(skipped * along, 2, 1e-5);
            EXPECT_NEAR(length_of(lens, made) * along, 3, 1e-5);
            EXPECT_NEAR(ray.cone_width, whole.cone_width + whole.cone_spread * skipped, 1e-6);
        });
    }
}

}  // namespace
}  // namespace obscura::test
