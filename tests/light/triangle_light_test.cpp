// tests/light/triangle_light_test.cpp - emissive triangles: geometry, facing, energy, lanes.
// SPDX-License-Identifier: Apache-2.0
#include "light/triangle_light.h"

#include "math/warp.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <cmath>
#include <limits>
#include <vector>

namespace obscura {
namespace {

TriangleLight test_light() {
    TriangleLight light = make_triangle_light({-1, 2, -1}, {1, 2, -1}, {-1, 2, 2});
    light.pdf_area = 1 / light.area;
    light.uv0[0] = 0.1F;
    light.uv1[0] = 0.9F;
    light.uv2[1] = 0.7F;
    light.emission[1] = 5;
    light.texture = 3;
    return light;
}

template <typename F>
Vec2<F> random_square(Pcg32& random) {
    const F x = random.next_float();
    return {x, random.next_float()};
}

TEST(TriangleLight, PointsLieOnTheTriangleWithTheirUv) {
    const TriangleLight light = test_light();
    EXPECT_FLOAT_EQ(light.area, 3);
    Pcg32 random(2);
    for (int i = 0; i < 1000; ++i) {
        const auto s =
            sample_triangle_light<float>(&light, 0, random_square<float>(random), {0, 0, 0});
        const float b1 = (s.point.x + 1) / 2;
        const float b2 = (s.point.z + 1) / 3;
        EXPECT_NEAR(s.point.y, 2, 1e-6);
        EXPECT_TRUE(b1 >= -1e-6F && b2 >= -1e-6F && b1 + b2 <= 1 + 1e-6F);
        EXPECT_NEAR(s.uv.x, 0.1F * (1 - b1 - b2) + 0.9F * b1, 1e-5);
        EXPECT_NEAR(s.uv.y, 0.7F * b2, 1e-5);
        EXPECT_NEAR(length(s.direction), 1, 1e-6);
        EXPECT_NEAR(s.distance, length(s.point), 1e-6);
        EXPECT_EQ(s.texture, 3);
        EXPECT_EQ(s.emission.y, 5);
    }
}

TEST(TriangleLight, FrontIsWhereTheCrossProductPoints) {
    TriangleLight light = test_light();  // counter-clockwise seen from below
    const Vec2<float> u{0.3F, 0.4F};
    const auto front = sample_triangle_light<float>(&light, 0, u, {0, 0, 0});
    EXPECT_NEAR(front.normal.y, -1, 1e-6);
    EXPECT_GT(front.cosine, 0);
    EXPECT_NEAR(front.pdf, front.distance * front.distance / (3 * front.cosine), 1e-5);
    const auto back = sample_triangle_light<float>(&light, 0, u, {0, 4, 0});
    EXPECT_LT(back.cosine, 0);
    EXPECT_EQ(back.pdf, 0);
    light.two_sided = 1;
    const auto both = sample_triangle_light<float>(&light, 0, u, {0, 4, 0});
    EXPECT_LT(both.cosine, 0);
    EXPECT_NEAR(both.pdf, front.pdf, 1e-5);  // the point below, mirrored
}

TEST(TriangleLight, PdfIncludesTheChoice) {
    TriangleLight light = test_light();
    const auto whole = sample_triangle_light<float>(&light, 0, {0.2F, 0.9F}, {0, 0, 0});
    light.pdf_area *= 0.25F;
    const auto quarter = sample_triangle_light<float>(&light, 0, {0.2F, 0.9F}, {0, 0, 0});
    EXPECT_FLOAT_EQ(quarter.pdf, 0.25F * whole.pdf);
}

/// Irradiance below a triangle against Lambert's boundary integral.
TEST(TriangleLight, IrradianceMatchesLambert) {
    const TriangleLight light = test_light();
    const Vec3d p[3] = {{-1, 2, -1}, {1, 2, -1}, {-1, 2, 2}};
    double expected = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3d a = normalize(p[i]);
        const Vec3d b = normalize(p[(i + 1) % 3]);
        expected += 0.5 * std::acos(dot(a, b)) * normalize(cross(a, b)).y;
    }
    expected = std::abs(expected) * 5;
    double sum = 0;
    constexpr int samples = 1 << 18;
    Pcg32 random(4);
    for (int i = 0; i < samples; ++i) {
        const auto s =
            sample_triangle_light<double>(&light, 0, random_square<double>(random), {0, 0, 0});
        sum += s.emission.y * s.direction.y / s.pdf;
    }
    EXPECT_NEAR(sum / samples / expected, 1, 5e-3);
}

TEST(TriangleLight, DegenerateTrianglesGiveNoLightAndNoNan) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<TriangleLight> lights = {
        make_triangle_light({1, 1, 1}, {1, 1, 1}, {1, 1, 1}),
        make_triangle_light({0, 1, 0}, {1, 1, 0}, {3, 1, 0}),
        make_triangle_light({nan, 1, 0}, {1, 1, 0}, {3, 1, 0}),
        make_triangle_light({-3e38F, 0, 0}, {3e38F, 0, 0}, {0, 3e38F, 0}),
        make_triangle_light({0, 1, 0}, {1e-30F, 1, 0}, {0, 1, 1e-30F})};
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].two_sided = 1;
        if (lights[i].area > 0) lights[i].pdf_area = 1 / lights[i].area;
        for (const Vec3f& from : {Vec3f{0, 0, 0}, Vec3f{0, 1, 0}, Vec3f{1, 1, 1}}) {
            const auto s = sample_triangle_light<float>(&lights[i], 0, {0.4F, 0.3F}, from);
            EXPECT_TRUE(std::isfinite(s.direction.x + s.direction.y + s.direction.z)) << i;
            EXPECT_TRUE(std::isfinite(s.normal.x + s.normal.y + s.normal.z)) << i;
            EXPECT_TRUE(std::isfinite(s.distance + s.cosine)) << i;
            EXPECT_EQ(s.pdf, 0) << i;
        }
    }
}

TEST(TriangleLight, TinyAndSliverTrianglesStayFinite) {
    Pcg32 random(9);
    for (int i = 0; i < 100000; ++i) {
        const float size = std::exp2(-40 + 50 * random.next_float());
        const float thin = std::exp2(-24 * random.next_float());
        const auto number = [&] { return (random.next_float() - 0.5F) * size; };
        const Vec3f p0{1, 2, 3};
        const Vec3f p1{p0.x + number(), p0.y + number(), p0.z + number()};
        const Vec3f along = p1 - p0;
        const Vec3f p2{
            p0.x + along.x * 2, p0.y + along.y * 2 + number() * thin, p0.z + along.z * 2};
        TriangleLight light = make_triangle_light(p0, p1, p2);
        light.two_sided = 1;
        if (light.area > 0) light.pdf_area = 1 / light.area;
        const auto s =
            sample_triangle_light<float>(&light, 0, random_square<float>(random), {0, 0, 0});
        ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0) << i;
        ASSERT_TRUE(std::isfinite(s.normal.x + s.normal.y + s.normal.z)) << i;
        ASSERT_LT(length(s.normal), 1.001F) << i;
    }
}

TEST(TriangleLight, FloatDoubleAndLanesAgree) {
    std::vector<TriangleLight> lights;
    Pcg32 random(5);
    const auto corner = [&] {
        const float x = random.next_float();
        const float y = random.next_float();
        return Vec3f{x, y, random.next_float() + 1};
    };
    for (int i = 0; i < 100; ++i) {
        const Vec3f a = corner();
        const Vec3f b = corner();
        lights.push_back(make_triangle_light(a, b, corner()));
        lights.back().pdf_area = 0.01F / lights.back().area;
        lights.back().two_sided = i % 2;
        lights.back().texture = i;
    }
    for (int round = 0; round < 500; ++round) {
        int32_t index[lane_count];
        float u[2][lane_count];
        for (int i = 0; i < lane_count; ++i) {
            index[i] = static_cast<int32_t>(random.next_uint() % 100);
            for (auto& number : u)
                number[i] = random.next_float();
        }
        const Vec2<Lanes> square{BatchF::load_unaligned(u[0]), BatchF::load_unaligned(u[1])};
        const auto lanes = sample_triangle_light<Lanes>(
            lights.data(), BatchI::load_unaligned(index), square, splat3(Lanes(0.25F)));
        float pdf[lane_count];
        float point[lane_count];
        int32_t texture[lane_count];
        lanes.pdf.v.store_unaligned(pdf);
        lanes.point.y.v.store_unaligned(point);
        lanes.texture.v.store_unaligned(texture);
        for (int i = 0; i < lane_count; ++i) {
            const auto f = sample_triangle_light<float>(
                lights.data(), index[i], {u[0][i], u[1][i]}, splat3(0.25F));
            const auto d = sample_triangle_light<double>(
                lights.data(), index[i], {u[0][i], u[1][i]}, splat3(0.25));
            EXPECT_EQ(texture[i], index[i]);
            EXPECT_NEAR(point[i], d.point.y, 1e-6);
            EXPECT_EQ(f.pdf > 0, d.pdf > 0);
            EXPECT_EQ(pdf[i] > 0, d.pdf > 0);
            const double grazing = 1e-4 + 1e-5 / std::abs(d.cosine);
            EXPECT_NEAR(f.pdf, d.pdf, grazing * d.pdf);
            EXPECT_NEAR(pdf[i], d.pdf, grazing * d.pdf);
        }
    }
}

}  // namespace
}  // namespace obscura
