// tests/accel/watertight_test.cpp - no ray leaks, and hits equal those of a search in double.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel.h"
#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using namespace test;

/// Rays from inside of a closed sphere that find no surface.
int leaks(const Vec3f& centre, Coherence coherence, int ray_count) {
    constexpr int rings = 100;
    SceneBuilder builder;
    builder.sphere(centre, 2.0F, rings, builder.material({}), true, true);
    Scene scene = builder.take();
    weld_sphere(scene, rings);
    const BuiltScene built = build(std::move(scene));
    RayList rays;
    Pcg32 random(1);
    for (int i = 0; i < ray_count; ++i) {
        const Vec3f origin = centre + random_unit(random) * random.next_float();
        rays.add(origin, random_unit(random));
    }
    EXPECT_EQ(rays.intersect(built.accel, coherence), 0);
    rays.occlude(built.accel, coherence);
    int missing = 0;
    for (int i = 0; i < ray_count; ++i) {
        const bool seen = rays.hit(i) && rays.t[static_cast<size_t>(i)] < 3.2F;
        missing += seen && rays.occluded[static_cast<size_t>(i)] == 1 ? 0 : 1;
    }
    return missing;
}

TEST(Watertight, ClosedSphereAtTheOriginLeaksNoRay) {
    for (const Coherence coherence : both_ways)
        EXPECT_EQ(leaks({0, 0, 0}, coherence, 500000 / thorough), 0);
}

TEST(Watertight, ClosedSphereFarAwayLeaksNoRay) {
    for (const Coherence coherence : both_ways)
        EXPECT_EQ(leaks({148376, 1234, -223423}, coherence, 500000 / thorough), 0);
}

struct TrueHit {
    double t = 1e300;
    int triangle = -1;
    double margin = 1e300;  ///< least distance of any barycentric from an edge, of all triangles
    double second = 1e300;  ///< distance of the next triangle behind
    double cosine = 0;      ///< of the ray and the triangle's normal
};

struct WideTriangle {
    Vec3d p, e1, e2, normal;
};

std::vector<WideTriangle> widen(const Scene& scene) {
    std::vector<WideTriangle> out;
    const auto vertex = [&](size_t i) {
        const float* p = &scene.positions[3 * static_cast<size_t>(scene.indices[i])];
        return Vec3d{p[0], p[1], p[2]};
    };
    for (size_t i = 0; i + 2 < scene.indices.size(); i += 3) {
        const Vec3d e1 = vertex(i + 1) - vertex(i);
        const Vec3d e2 = vertex(i + 2) - vertex(i);
        out.push_back({vertex(i), e1, e2, cross(e1, e2)});
    }
    return out;
}

/// Tests every triangle in double.
TrueHit search(const std::vector<WideTriangle>& triangles, const Vec3d& o, const Vec3d& d) {
    TrueHit best;
    for (size_t i = 0; i < triangles.size(); ++i) {
        const WideTriangle& w = triangles[i];
        const double along = dot(d, w.normal);
        const Vec3d to_corner = w.p - o;
        const double t = dot(to_corner, w.normal) / along;
        if (!(t > 0)) continue;
        const Vec3d r = cross(d, to_corner);
        const double u = -dot(r, w.e2) / along;
        const double v = dot(r, w.e1) / along;
        const double inside = std::min({u, v, 1 - u - v});
        best.margin = std::min(best.margin, std::abs(inside));
        if (inside < 0) continue;
        if (t < best.t) {
            best.second = best.t;
            best.t = t;
            best.triangle = static_cast<int>(i);
            best.cosine = std::abs(along) / length(w.normal);
        } else {
            best.second = std::min(best.second, t);
        }
    }
    return best;
}

/// Triangles with corners anywhere in a cube.
Scene triangle_soup(uint64_t seed, int count) {
    SceneBuilder builder;
    builder.material({});
    Pcg32 random(seed);
    Scene& scene = builder.scene();
    Primitive primitive;
    primitive.triangle_count = count;
    scene.primitives.push_back(primitive);
    for (uint32_t i = 0; i < 3U * static_cast<uint32_t>(count); ++i) {
        const Vec3f p = random_in_cube(random, 1.0F);
        scene.positions.insert(scene.positions.end(), {p.x, p.y, p.z});
        scene.indices.push_back(i);
    }
    return builder.take();
}

struct Disagreements {
    int unexplained = 0;  ///< not at an edge and not a tie
    int other = 0;        ///< another triangle, or hit against miss
    int distance = 0;     ///< t off by more than 1e-5
    int hits = 0;
};

Disagreements compare(const Scene& soup, Coherence coherence, int ray_count) {
    const std::vector<WideTriangle> triangles = widen(soup);
    const BuiltScene built = build(soup);
    RayList rays;
    Pcg32 random(7);
    for (int i = 0; i < ray_count; ++i) {
        const Vec3f origin = random_in_cube(random, 2.0F);
        rays.add(origin, normalize(random_in_cube(random, 1.0F) - origin));
    }
    rays.intersect(built.accel, coherence);
    Disagreements out;
    for (int i = 0; i < ray_count; ++i) {
        const Vec3f o = rays.origin(i);
        const Vec3f d = rays.direction(i);
        const TrueHit truth = search(triangles, {o.x, o.y, o.z}, {d.x, d.y, d.z});
        const auto index = static_cast<size_t>(i);
        const int got = rays.hit(i) ? rays.triangle[index] : -1;
        out.hits += got >= 0 ? 1 : 0;
        if (got != truth.triangle) {
            ++out.other;
            const bool tie = truth.second - truth.t < 1e-5 * (1 + truth.t);
            const bool behind = truth.t < 1e-5;  // the origin lies on the triangle
            if (truth.margin > 1e-5 && !tie && !behind) ++out.unexplained;
            continue;
        }
        if (got < 0) continue;
        const double error = std::abs(rays.t[index] - truth.t) / (truth.t + 0.1);
        out.distance += error > 1e-5 / std::min(1.0, 10 * truth.cosine) ? 1 : 0;
    }
    return out;
}

TEST(Watertight, HitsAreThoseOfASearchInDouble) {
    constexpr int meshes = 5;
    constexpr int rays = 100000 / thorough;
    Disagreements sum;
    for (uint64_t seed = 0; seed < meshes; ++seed) {
        const Scene soup = triangle_soup(seed, 60);
        for (const Coherence coherence : both_ways) {
            const Disagreements one = compare(soup, coherence, rays);
            EXPECT_GT(one.hits, rays / 4);
            sum.unexplained += one.unexplained;
            sum.other += one.other;
            sum.distance += one.distance;
        }
    }
    EXPECT_EQ(sum.unexplained, 0);
    EXPECT_LE(sum.other, 20) << "edges that a ray meets within float's precision, of 10^6 rays";
    EXPECT_LE(sum.distance, 10);
}

}  // namespace
}  // namespace obscura
