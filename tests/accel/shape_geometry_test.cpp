// tests/accel/shape_geometry_test.cpp - shapes as user geometry: callbacks of 1, 4, 8 and 16 rays.
// SPDX-License-Identifier: Apache-2.0
#include "accel/shape_geometry.h"

#include "accel/accel_scenes.h"
#include "accel/dispatch.h"
#include "shape/shape_truth.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"

namespace obscura::test {
namespace {

/// One ray as the callbacks get it.
struct Asked {
    ShapeRay<float> ray;
    float tnear = 0;
    float tfar = 3e38F;
};

struct Answer {
    bool hit = false;
    float t = 0;
    unsigned primitive = 0;
};

/// Calls `callbacks` with N rays at once; lanes from `active` on are idle.
template <unsigned N>
std::vector<Answer> ask(const ShapeCallbacks& callbacks,
                        const ShapeGeometry& geometry,
                        const std::vector<Asked>& asked,
                        bool culls = false) {
    alignas(64) float rays[N * 24] = {};
    std::fill_n(reinterpret_cast<unsigned*>(rays) + 17 * N, 2 * N, RTC_INVALID_GEOMETRY_ID);
    alignas(64) int valid[N] = {};
    for (unsigned i = 0; i < N && i < asked.size(); ++i) {
        const auto& [origin, direction] = asked[i].ray;
        const float fields[9] = {origin.x,
                                 origin.y,
                                 origin.z,
                                 asked[i].tnear,
                                 direction.x,
                                 direction.y,
                                 direction.z,
                                 0,
                                 asked[i].tfar};
        for (unsigned f = 0; f < 9; ++f)
            rays[f * N + i] = fields[f];
        valid[i] = -1;
    }
    QueryContext context;
    const Query query(context, false);
    context.culls_back_faces = culls;
    RTCIntersectFunctionNArguments args = {};
    args.valid = valid;
    args.geometryUserPtr = const_cast<ShapeGeometry*>(&geometry);
    args.context = &context.embree;
    args.rayhit = reinterpret_cast<RTCRayHitN*>(rays);
    args.N = N;
    args.geomID = 5;
    callbacks.intersect(&args);
    std::vector<Answer> out;
    for (unsigned i = 0; i < N && i < asked.size(); ++i) {
        RTCHitN* hits = RTCRayHitN_HitN(args.rayhit, N);
        out.push_back(
            {RTCHitN_geomID(hits, N, i) == 5, rays[8 * N + i], RTCHitN_primID(hits, N, i)});
    }
    return out;
}

const char* const isa_names[] = {"sse4.2", "avx2", "avx512"};

std::vector<const ShapeCallbacks*> all_callbacks() {
    std::vector<const ShapeCallbacks*> out;
    for (const Isa isa : all_isas())
        out.push_back(accel_functions_for(isa_names[static_cast<size_t>(isa) - 1]).shapes);
    return out;
}

void expect_same(const std::vector<Answer>& got, const std::vector<Answer>& one, size_t first) {
    for (size_t i = 0; i < got.size(); ++i) {
        ASSERT_EQ(got[i].hit, one[first + i].hit) << i;
        if (!got[i].hit) continue;
        ASSERT_NEAR(got[i].t, one[first + i].t, 1e-4F * (1 + std::fabs(got[i].t)));
    }
}

/// All widths against one ray at a time.
void expect_widths_agree(const ShapeCallbacks& callbacks,
                         const ShapeGeometry& geometry,
                         const std::vector<Asked>& asked,
                         bool culls) {
    std::vector<Answer> one;
    for (const Asked& a : asked)
        one.push_back(ask<1>(callbacks, geometry, {a}, culls)[0]);
    const auto part = [&](size_t first, size_t count) {
        return std::vector<Asked>(asked.begin() + static_cast<long>(first),
                                  asked.begin() + static_cast<long>(first + count));
    };
    for (size_t i = 0; i + 16 <= asked.size(); i += 16) {
        expect_same(ask<16>(callbacks, geometry, part(i, 16), culls), one, i);
        expect_same(ask<16>(callbacks, geometry, part(i, 7), culls), one, i);  // idle lanes
        expect_same(ask<8>(callbacks, geometry, part(i, 8), culls), one, i);
        expect_same(ask<4>(callbacks, geometry, part(i, 4), culls), one, i);
    }
}

std::vector<Asked> random_questions(const ShapeRecord& record, int count) {
    Pcg32 random(3);
    std::vector<Asked> asked;
    for (int i = 0; i < count; ++i) {
        Asked a{random_ray(record, i % 2 == 0 ? 0.0F : 3.0F, random)};
        if (i % 3 == 0) a.tnear = 2.0F * random.next_float();
        if (i % 5 == 0) a.tfar = a.tnear + 4.0F * random.next_float();
        asked.push_back(a);
    }
    return asked;
}

TEST(ShapeCallbacks, AllWidthsAgreeOnEveryShape) {
    for (const ShapeCallbacks* callbacks : all_callbacks()) {
        for (const NamedShape& shape : sample_shapes()) {
            SCOPED_TRACE(shape.name);
            for (const bool culls : {false, true}) {
                const ShapeGeometry geometry{&shape.record, nullptr, 1, true};
                const auto asked = random_questions(shape.record, 16 * 20);
                expect_widths_agree(*callbacks, geometry, asked, culls);
            }
        }
    }
}

TEST(ShapeCallbacks, HitsLieBetweenTnearAndTfar) {
    const ShapeRecord sphere = shape_record(ShapeKind::sphere, 1, 0, 0);
    const ShapeGeometry geometry{&sphere, nullptr, 1};
    const ShapeRay<float> ray{{0, 0, 3}, {0, 0, -1}};
    for (const ShapeCallbacks* callbacks : all_callbacks()) {
        EXPECT_FLOAT_EQ(ask<1>(*callbacks, geometry, {{ray}})[0].t, 2.0F);
        EXPECT_FLOAT_EQ(ask<4>(*callbacks, geometry, {{ray, 2.5F}})[0].t, 4.0F);
        EXPECT_FALSE(ask<8>(*callbacks, geometry, {{ray, 2.5F, 3.5F}})[0].hit);
        EXPECT_FALSE(ask<16>(*callbacks, geometry, {{ray, 4.5F}})[0].hit);  // both roots behind
        EXPECT_FLOAT_EQ(ask<16>(*callbacks, geometry, {{{{0, 0, 0}, {0, 0, -1}}}})[0].t, 1.0F);
    }
}

/// The nearest of some spheres by the formula in double.
NearHit<double> nearest_of(const std::vector<float>& spheres,
                           const ShapeRay<float>& ray,
                           size_t& which) {
    NearHit<double> best{1e30, false};
    for (size_t s = 0; s < spheres.size() / 4; ++s) {
        const float* at = &spheres[4 * s];
        const Sphere<double> sphere{{at[0], at[1], at[2]}, at[3]};
        const auto hit = nearest(intersect_sphere(sphere, ray_cast_to<double>(ray)), 0.0, best.t);
        if (!hit.found) continue;
        best = hit;
        which = s;
    }
    return best;
}

void expect_nearest_of(const std::vector<float>& spheres, Isa isa) {
    Scene scene = empty_scene({});
    add_spheres(scene, spheres, 0);
    const BuiltScene built = build(std::move(scene), embree_isa_for(isa));
    Pcg32 random(5);
    RayList rays;
    for (int i = 0; i < 2000; ++i) {
        const Vec3f origin = random_unit(random) * (i % 2 == 0 ? 3.0F : 0.5F);
        rays.add(origin, normalize(random_in_cube(random, 1) - origin));
    }
    rays.intersect(built.accel, Coherence::incoherent);
    rays.occlude(built.accel, Coherence::incoherent);
    int hits = 0;
    for (int i = 0; i < rays.count(); ++i) {
        const auto index = static_cast<size_t>(i);
        size_t which = 0;
        const NearHit<double> hit = nearest_of(spheres, {rays.origin(i), rays.direction(i)}, which);
        ASSERT_EQ(rays.hit(i), hit.found) << i;
        ASSERT_EQ(rays.occluded[index] != 0, hit.found) << i;
        if (!hit.found) continue;
        ++hits;
        ASSERT_EQ(static_cast<size_t>(rays.triangle[index]), which) << i;
        ASSERT_NEAR(rays.t[index], hit.t, 1e-5);
    }
    EXPECT_GT(hits, 300);
}

/// Three clusters of up to 256 spheres.
TEST(ShapeCallbacks, ClustersFindTheNearestSphere) {
    Pcg32 random(5);
    std::vector<float> spheres;
    for (int i = 0; i < 600; ++i) {
        for (int c = 0; c < 3; ++c)
            spheres.push_back(between(random, -1, 1));
        spheres.push_back(between(random, 0.02F, 0.12F));
    }
    for (const Isa isa : all_isas())
        expect_nearest_of(spheres, isa);
}

TEST(ShapeScenes, EveryInstructionSetAndWayAgrees) {
    const auto shapes = sample_shapes();
    std::vector<std::vector<int32_t>> found;
    for (const Isa isa : all_isas()) {
        for (const Coherence way : both_ways) {
            Scene scene = empty_scene({});
            float x = -12;
            for (const NamedShape& shape : shapes)
                add_shape(scene, scaled_and_moved(shape.record, 1, {x += 1.3F, 0, 0}), 0);
            add_shape(scene, make_shape(ShapeKind::sphere, 1), 0, scaling(1, -2, 0.5, {0, 4, 0}));
            const BuiltScene built = build(std::move(scene), embree_isa_for(isa));
            Pcg32 random(8);
            RayList rays;
            for (int i = 0; i < 4000; ++i)
                rays.add(random_in_cube(random, 14), normalize(random_in_cube(random, 1)));
            rays.intersect(built.accel, way);
            rays.occlude(built.accel, Coherence::incoherent);
            for (int i = 0; i < rays.count(); ++i)
                ASSERT_EQ(rays.hit(i), rays.occluded[static_cast<size_t>(i)] != 0) << i;
            found.push_back(rays.primitive);
        }
    }
    for (const auto& other : found) {
        int differing = 0;
        for (size_t i = 0; i < 4000; ++i)
            differing += other[i] != found[0][i] ? 1 : 0;
        EXPECT_LE(differing, 8);  // on outlines
    }
}

TEST(ShapeScenes, PlanesWithoutEndAreMetBesideTheHierarchy) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    add_shape(
        scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0, scaling(1, 1, 1, {0, -1, 0}));
    const BuiltScene built = build(std::move(scene));
    RayList rays;
    rays.add({0, 3, 0}, {0, -1, 0});                      // the sphere is nearer
    rays.add({1e6F, 4, -1e6F}, {0, -1, 0});               // the plane far out
    rays.add({0, 3, 0}, {0, 1, 0});                       // nothing above
    rays.add({2, 0, 0}, normalize(Vec3f{1, -1e-3F, 0}));  // grazing
    rays.add({2, 0, 0}, {1, 0, 0});                       // along it
    rays.intersect(built.accel, Coherence::incoherent);
    rays.occlude(built.accel, Coherence::incoherent);
    EXPECT_FLOAT_EQ(rays.t[0], 2.0F);
    EXPECT_EQ(rays.primitive[0], 0);
    EXPECT_FLOAT_EQ(rays.t[1], 5.0F);
    EXPECT_EQ(rays.instance[1], 0);
    EXPECT_FALSE(rays.hit(2));
    EXPECT_NEAR(rays.t[3], 1000, 0.01);
    EXPECT_FALSE(rays.hit(4));
    EXPECT_EQ(std::vector<uint8_t>(rays.occluded.begin(), rays.occluded.begin() + 5),
              (std::vector<uint8_t>{1, 1, 0, 1, 0}));
}

/// As a camera's far distance and the dark corners of a fisheye ask.
TEST(ShapeScenes, RaysEndBeforeInfinitePlanes) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0, scaling(1, 1, 1, {}));
    const BuiltScene built = build(std::move(scene));
    RayList rays;
    for (const float tfar : {0.0F, 2.9F, 3.1F})
        rays.add({0, 3, 0}, {0, -1, 0}, tfar);
    rays.intersect(built.accel, Coherence::coherent);
    rays.occlude(built.accel, Coherence::coherent);
    for (const int index : {0, 1, 2}) {
        EXPECT_EQ(rays.hit(index), index == 2) << index;
        EXPECT_EQ(rays.occluded[static_cast<size_t>(index)], index == 2 ? 1 : 0) << index;
    }
}

TEST(ShapeScenes, BacksOfSingleSidedShapesAreHiddenFromTheCamera) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    const BuiltScene built = build(std::move(scene));
    RayList rays;
    rays.add({0, 0, 0}, {0, 0, 1});
    rays.intersect(built.accel, Coherence::coherent, {true, false, 0});
    EXPECT_FALSE(rays.hit(0));
    rays.intersect(built.accel, Coherence::coherent, {false, false, 0});
    EXPECT_TRUE(rays.hit(0));
}

TEST(ShapeScenes, AlphaLetsRaysThroughTwice) {
    Material half;
    half.base_color[3] = 0.5F;
    half.flags |= material_alpha_blend | material_double_sided;
    Scene scene = empty_scene(half);
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    const BuiltScene built = build(std::move(scene));
    RayList rays;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i)
        rays.add({0, 0, 3}, {0, 0, -1});
    rays.intersect(built.accel, Coherence::incoherent);
    int front = 0;
    int back = 0;
    for (int i = 0; i < count; ++i) {
        if (!rays.hit(i)) continue;
        ++(rays.t[static_cast<size_t>(i)] < 3 ? front : back);
    }
    EXPECT_NEAR(front, count / 2, 300);
    EXPECT_NEAR(back, count / 4, 300);
}

}  // namespace
}  // namespace obscura::test
