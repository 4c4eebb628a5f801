// tests/accel/coplanar_test.cpp - surfaces in one place: which one a ray hits is its own affair.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel.h"
#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include <algorithm>
#include <numeric>
#include <tuple>

namespace obscura {
namespace {

using namespace test;

/// Squares that tile the sides of a cube, turned by `turn`: two layers in one plane, whose squares
/// have other sizes, so that the hierarchy sorts them into different boxes.
Scene cube_of_two_layers(const Affined& turn) {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    const auto place = [&](const double(&p)[3]) {
        const Vec3d q = transform_point(turn, Vec3d{p[0], p[1], p[2]});
        return Vec3f{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
    };
    for (const int squares : {7, 5}) {
        const double side = 2.0 / squares;
        for (int axis = 0; axis < 3; ++axis) {
            for (int i = 0; i < 2 * squares * squares; ++i) {
                double p[3];
                p[axis] = i % 2 == 0 ? -1 : 1;
                p[(axis + 1) % 3] = -1 + side * (i / 2 % squares);
                p[(axis + 2) % 3] = -1 + side * (i / 2 / squares);
                double a[3] = {p[0], p[1], p[2]};
                double b[3] = {p[0], p[1], p[2]};
                a[(axis + 1) % 3] += side;
                b[(axis + 2) % 3] += side;
                const Vec3f corner = place(p);
                builder.quad(corner, place(a) - corner, place(b) - corner, material);
            }
        }
    }
    return builder.take();
}

Affined turned() {
    const double c = std::cos(0.6);
    const double s = std::sin(0.6);
    Affined a = scaling(1, 1, 1, {0.3, -0.2, 0.1});
    a.m[0][0] = c;
    a.m[0][1] = -s;
    a.m[1][0] = s * c;
    a.m[1][1] = c * c;
    a.m[1][2] = -s;
    a.m[2][0] = s * s;
    a.m[2][1] = c * s;
    a.m[2][2] = c;
    return a;
}

struct Hit {
    float t, u, v;
    int32_t instance, primitive, triangle;
    auto all() const { return std::tie(t, u, v, instance, primitive, triangle); }
    bool operator==(const Hit& other) const { return all() == other.all(); }
};

/// Traces rays in calls of up to `at_once`, in an order; returns the hits in the order of the rays.
std::vector<Hit> hits_of(const Accel& accel,
                         const RayList& rays,
                         const std::vector<int>& order,
                         int at_once,
                         Coherence coherence) {
    std::vector<Hit> out(order.size());
    for (size_t first = 0; first < order.size(); first += static_cast<size_t>(at_once)) {
        const size_t end = std::min(order.size(), first + static_cast<size_t>(at_once));
        RayList some;
        for (size_t i = first; i < end; ++i)
            some.add(rays.origin(order[i]), rays.direction(order[i]));
        some.intersect(accel, coherence);
        for (size_t i = first; i < end; ++i) {
            const size_t k = i - first;
            Hit& hit = out[static_cast<size_t>(order[i])];
            if (some.primitive[k] < 0) {
                hit = {0, 0, 0, -1, -1, -1};
            } else {
                hit = {some.t[k],
                       some.u[k],
                       some.v[k],
                       some.instance[k],
                       some.primitive[k],
                       some.triangle[k]};
            }
        }
    }
    return out;
}

/// Rays from within the cube, some from afar, and some that graze one of its sides.
RayList rays_at_the_cube() {
    Pcg32 random(7);
    RayList rays;
    const int count = 40000 / thorough;
    for (int i = 0; i < count; ++i) {
        Vec3f origin = random_in_cube(random, 0.6F);
        Vec3f direction = random_unit(random);
        if (i % 8 == 0) origin = origin - direction * 300.0F;
        if (i < count / 4) {
            direction.x = std::pow(10.0F, between(random, -6, -1.5F));
            origin.x = 1 - between(random, 0, 0.5F) * direction.x;
        }
        rays.add(origin, direction);
    }
    return rays;
}

/// How many rays of all have another hit where they are traced in another company.
int other_hits(const Accel& accel, const RayList& rays) {
    std::vector<int> order(static_cast<size_t>(rays.count()));
    std::iota(order.begin(), order.end(), 0);
    const std::vector<Hit> alone = hits_of(accel, rays, order, 1, Coherence::incoherent);
    int others = 0;
    Pcg32 random(3);
    for (const Coherence coherence : both_ways) {
        for (int round = 0; round < 3; ++round) {
            const std::vector<Hit> hits = hits_of(accel, rays, order, 1000, coherence);
            for (size_t i = 0; i < hits.size(); ++i)
                others += hits[i] == alone[i] ? 0 : 1;
            for (size_t i = order.size() - 1; i > 0; --i)
                std::swap(order[i], order[random.next_uint() % (i + 1)]);
        }
    }
    return others;
}

TEST(CoplanarSurfaces, AHitIsThatOfTheRayAlone) {
    const RayList rays = rays_at_the_cube();
    for (const Isa isa : all_isas()) {
        const std::string name = embree_isa_for(isa);
        for (const Affined& turn : {scaling(1, 1, 1), turned()}) {
            const BuiltScene in_world = build(cube_of_two_layers(turn), name);
            EXPECT_EQ(other_hits(in_world.accel, rays), 0) << name;
        }
        const std::vector<Affined> placings(5, turned());
        const BuiltScene often = build(instanced(cube_of_two_layers(turned()), placings), name);
        EXPECT_EQ(other_hits(often.accel, rays), 0) << name << ", instances";
        // Their own coordinates may be much larger.
        const Scene far_away = cube_of_two_layers(scaling(1, 1, 1, {-4096, 0, 2048}));
        const std::vector<Affined> back(3, scaling(1, 1, 1, {4096, 0, -2048}));
        const BuiltScene shifted = build(instanced(far_away, back), name);
        EXPECT_EQ(other_hits(shifted.accel, rays), 0) << name << ", shifted";
    }
}

/// Rays through the pixels of a picture, from one point or all along one direction.
RayList rays_of_a_camera(const Vec3f& eye, bool is_orthographic) {
    RayList rays;
    constexpr int side = 60;  // no whole streams in a row
    for (int i = 0; i < side * side; ++i) {
        const float x = static_cast<float>(i % side) / side - 0.45F;
        const float y = static_cast<float>(i / side) / side - 0.55F;
        if (is_orthographic) {
            rays.add(eye + Vec3f{2 * x, 2 * y, 0}, {0, -0.0F, -1});
        } else {
            rays.add(eye, {x, y, -0.8F});
        }
    }
    return rays;
}

/// As they go much the same way, they are traced in streams.
TEST(CoplanarSurfaces, RaysOfACameraHitWhatEachHitsAlone) {
    for (const Isa isa : all_isas()) {
        const std::string name = embree_isa_for(isa);
        for (const Affined& turn : {scaling(1, 1, 1), turned()}) {
            const BuiltScene meshes = build(cube_of_two_layers(turn), name);
            Scene scene = cube_of_two_layers(turn);
            add_shape(scene, make_shape(ShapeKind::sphere, 0.3F), 0);
            add_shape(scene, make_shape(ShapeKind::box, 1, 0.5F, 1), 0);
            const BuiltScene mixed = build(std::move(scene), name);
            for (const Vec3f& eye : {Vec3f{0.1F, 0.2F, 0.9F}, Vec3f{0, 0, 3}, Vec3f{4, 3, 20}}) {
                EXPECT_EQ(other_hits(mixed.accel, rays_of_a_camera(eye, false)), 0) << name;
                EXPECT_EQ(other_hits(meshes.accel, rays_of_a_camera(eye, true)), 0) << name;
            }
        }
    }
}

TEST(CoplanarSurfaces, ShapesCountAsTriangles) {
    const RayList rays = rays_at_the_cube();
    Scene scene = cube_of_two_layers(scaling(1, 1, 1));
    ShapeRecord disk = make_shape(ShapeKind::disk, 0.9F);
    disk.centre[1] = -1;
    add_shape(scene, disk, 0);
    add_shape(scene, make_shape(ShapeKind::box, 1, 1, 1), 0);
    add_shape(scene, make_shape(ShapeKind::box, 1, 0.5F, 1), 0);
    for (const Isa isa : all_isas()) {
        const std::string name = embree_isa_for(isa);
        const BuiltScene built = build(Scene(scene), name);
        EXPECT_EQ(other_hits(built.accel, rays), 0) << name;
    }
}

/// A square, all of whose triangles are there `times` times, in one primitive.
Scene repeated_square(size_t times) {
    SceneBuilder builder;
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material({}));
    Scene scene = builder.take();
    const std::vector<uint32_t> once(scene.indices.begin(), scene.indices.end());
    for (size_t k = 1; k < times; ++k)
        scene.indices.insert(scene.indices.end(), once.begin(), once.end());
    scene.primitives[0].triangle_count = static_cast<int32_t>(scene.indices.size() / 3);
    return scene;
}

TEST(CoplanarSurfaces, OfEquallyNearTrianglesTheFirstIsHit) {
    for (const Isa isa : all_isas()) {
        const BuiltScene built = build(repeated_square(20), embree_isa_for(isa));
        RayList rays;
        for (int i = 0; i < 64; ++i)
            rays.add({-0.9F + 0.027F * static_cast<float>(i), 0.31F, 3}, {0, 0, -1});
        for (const Coherence coherence : both_ways) {
            rays.intersect(built.accel, coherence);
            for (size_t i = 0; i < 64; ++i)
                EXPECT_LT(rays.triangle[i], 2);
        }
    }
}

TEST(CoplanarSurfaces, OfEquallyNearOnesTheFirstIsHit) {
    for (const Isa isa : all_isas()) {
        SceneBuilder builder;
        const int32_t material = builder.material({});
        for (int k = 0; k < 20; ++k)
            builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, material);
        const BuiltScene built = build(builder.take(), embree_isa_for(isa));
        RayList rays;
        for (int i = 0; i < 64; ++i)
            rays.add({-0.9F + 0.027F * static_cast<float>(i), 0.31F, 3}, {0, 0, -1});
        rays.intersect(built.accel, Coherence::coherent);
        for (int i = 0; i < 64; ++i)
            EXPECT_EQ(rays.primitive[static_cast<size_t>(i)], 0);
    }
}

}  // namespace
}  // namespace obscura
