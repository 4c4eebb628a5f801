// tests/accel/queries_test.cpp - unsafe rays, packets of every size, ids, and hidden back faces.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel.h"
#include "accel/accel_impl.h"
#include "accel/accel_scenes.h"
#include "math/sampler.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include <limits>

namespace obscura {
namespace {

using namespace test;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// A 2 x 2 square at height z that faces +Z, or -Z when turned over.
void add_square(SceneBuilder& builder, float z, int32_t material, bool turned = false) {
    const Vec3f p{-1, -1, z};
    if (turned) {
        builder.quad(p, {0, 2, 0}, {2, 0, 0}, material);
    } else {
        builder.quad(p, {2, 0, 0}, {0, 2, 0}, material);
    }
}

BuiltScene one_square(Isa isa = Isa::automatic) {
    SceneBuilder builder;
    add_square(builder, 0, builder.material({}));
    return build(builder.take(), embree_isa_for(isa));
}

TEST(Accel, LinesNeedAnEmbreeWithCurves) {
    Scene scene;
    EXPECT_TRUE(require_curves(scene, false));
    scene.curve_segments = {0};
    EXPECT_TRUE(require_curves(scene, true));
    const Result<void> without = require_curves(scene, false);
    ASSERT_FALSE(without);
    EXPECT_EQ(without.error().id, "E-EMBREE-CURVES");
    EXPECT_EQ(without.error().code, ExitCode::unsupported);
}

TEST(Accel, FilterFunctionsAreNeeded) {
    EXPECT_TRUE(require_filters(true));
    const Result<void> without = require_filters(false);
    ASSERT_FALSE(without);
    EXPECT_EQ(without.error().id, "E-EMBREE-FILTERS");
    EXPECT_EQ(without.error().code, ExitCode::unsupported);
}

TEST(Accel, ADeviceThatFindsNoMemoryIsNoBug) {
    const Error memory = device_failure(RTC_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(memory.id, "E-MEM");
    EXPECT_EQ(memory.code, ExitCode::out_of_memory);
    const Error other = device_failure(RTC_ERROR_UNSUPPORTED_CPU);
    EXPECT_EQ(other.id, "E-EMBREE");
    EXPECT_EQ(other.code, ExitCode::internal);
    EXPECT_EQ(other.message, "it makes no device: its error 5");
}

/// Origins and directions that Embree must never get.
std::vector<std::pair<Vec3f, Vec3f>> unsafe_rays() {
    std::vector<std::pair<Vec3f, Vec3f>> unsafe;
    for (const float bad : {nan, infinity, -infinity, 1e30F, -3e38F}) {
        for (int axis = 0; axis < 3; ++axis) {
            float o[3] = {0, 0, 5};
            float d[3] = {0, 0, -1};
            o[axis] = bad;
            unsafe.push_back({{o[0], o[1], o[2]}, {0, 0, -1}});
            d[axis] = bad;
            unsafe.push_back({{0, 0, 5}, {d[0], d[1], d[2]}});
        }
    }
    unsafe.push_back({{0, 0, 5}, {0, 0, 0}});
    unsafe.push_back({{0, 0, 5}, {-0.0F, 0, -0.0F}});
    return unsafe;
}

constexpr int strip_squares = 64;

/// A strip of squares along X, each a primitive and cut into triangles.
BuiltScene strip(Isa isa) {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    for (int k = 0; k < strip_squares; ++k)
        builder.quad({static_cast<float>(k), 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
    return build(builder.take(), embree_isa_for(isa));
}

/// What a ray straight down on the edge at x hits, with others at `side` of it, or alone.
int32_t hit_on_edge(const BuiltScene& built, float x, float y, float side, int others) {
    RayList rays;
    for (int i = 0; i <= others; ++i)
        rays.add({x + side * static_cast<float>(i), y, 2}, {0, 0, -1});
    rays.intersect(built.accel, Coherence::coherent);
    return rays.primitive[0];
}

TEST(Queries, AHitOnAnEdgeDoesNotDependOnOtherRays) {
    for (const Isa isa : all_isas()) {
        const BuiltScene built = strip(isa);
        for (int k = 1; k < strip_squares; ++k) {
            const auto x = static_cast<float>(k);
            for (const float y : {0.25F, 0.375F, 0.7F}) {
                const int32_t alone = hit_on_edge(built, x, y, 0, 0);
                EXPECT_TRUE(alone == k || alone == k - 1);
                for (const float side : {-4.0F, -1.0F, -0.25F, 0.25F, 1.0F, 4.0F})
                    ASSERT_EQ(hit_on_edge(built, x, y, side, 15), alone) << k << ", " << side;
            }
        }
    }
}

TEST(Queries, UnsafeRaysAreRefusedAndCounted) {
    const auto unsafe = unsafe_rays();
    RayList rays;  // bad ones among good ones
    for (const auto& [origin, direction] : unsafe) {
        rays.add({0.1F, 0.2F, 5}, {0, 0, -1});
        rays.add(origin, direction);
    }
    const int bad = static_cast<int>(unsafe.size());
    for (const Isa isa : all_isas()) {
        const BuiltScene built = one_square(isa);
        for (const Coherence coherence : both_ways) {
            EXPECT_EQ(rays.intersect(built.accel, coherence), bad);
            EXPECT_EQ(rays.occlude(built.accel, coherence), bad);
            for (int i = 0; i < rays.count(); ++i) {
                const auto index = static_cast<size_t>(i);
                EXPECT_EQ(rays.hit(i), i % 2 == 0) << i;
                EXPECT_EQ(rays.occluded[index], 1) << "refused rays bring no light, ray " << i;
                if (i % 2 == 0) {
                    EXPECT_NEAR(rays.t[index], 5.0F, 1e-5F);
                }
            }
        }
    }
}

TEST(Queries, RefusedRaysTakeNoHitsFromTheOthers) {
    const auto [origin, direction] = unsafe_rays().front();
    for (const Isa isa : all_isas()) {
        const BuiltScene built = one_square(isa);
        for (int refused = 0; refused < 32; ++refused) {
            RayList rays;
            for (int i = 0; i < refused; ++i)
                rays.add(origin, direction);
            for (int i = 0; i < 5; ++i)
                rays.add({0.1F * static_cast<float>(i), 0.2F, 3}, {0, 0, -1});
            for (const Coherence coherence : both_ways) {
                EXPECT_EQ(rays.intersect(built.accel, coherence), refused);
                for (int i = 0; i < refused + 5; ++i)
                    EXPECT_EQ(rays.hit(i), i >= refused) << refused << ", " << i;
            }
        }
    }
}

TEST(Queries, PacketsOfUnsafeRaysOnly) {
    RayList rays;
    for (const auto& [origin, direction] : unsafe_rays())
        rays.add(origin, direction);
    for (const Isa isa : all_isas()) {
        const BuiltScene built = one_square(isa);
        for (const Coherence coherence : both_ways) {
            EXPECT_EQ(rays.intersect(built.accel, coherence), rays.count());
            EXPECT_EQ(rays.occlude(built.accel, coherence), rays.count());
            for (int i = 0; i < rays.count(); ++i) {
                EXPECT_FALSE(rays.hit(i)) << i;
                EXPECT_EQ(rays.occluded[static_cast<size_t>(i)], 1) << i;
            }
        }
    }
}

TEST(Queries, EndsOfRaysAreChecked) {
    const BuiltScene built = one_square();
    for (const Coherence coherence : both_ways) {
        RayList rays;
        for (const float tfar : {nan, -1.0F, -infinity, 4.9F, 5.1F, 0.0F, infinity})
            rays.add({0.1F, 0.2F, 5}, {0, 0, -1}, tfar);
        EXPECT_EQ(rays.occlude(built.accel, coherence), 3);
        const std::vector<uint8_t> expected = {1, 1, 1, 0, 1, 0, 1};
        for (size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(rays.occluded[i], expected[i]) << i;
        EXPECT_EQ(rays.intersect(built.accel, coherence), 3);
        for (int i = 0; i < rays.count(); ++i)
            EXPECT_EQ(rays.hit(i), i == 4 || i == 6) << i;
    }
}

void expect_packet(const BuiltScene& built, int count, Coherence coherence) {
    RayList rays;
    for (int i = 0; i < count; ++i) {
        const float x = i % 3 != 0 ? 0.01F * static_cast<float>(i) : 3.0F;  // every third misses
        rays.add({x, 0.5F, 1 + static_cast<float>(i)}, {0, 0, -1});
    }
    EXPECT_EQ(rays.intersect(built.accel, coherence), 0);
    EXPECT_EQ(rays.occlude(built.accel, coherence), 0);
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<size_t>(i);
        EXPECT_EQ(rays.hit(i), i % 3 != 0) << i << " of " << count;
        EXPECT_EQ(rays.occluded[index], i % 3 != 0 ? 1 : 0) << i << " of " << count;
        if (rays.hit(i)) {
            EXPECT_NEAR(rays.t[index], 1 + static_cast<float>(i), 1e-5F);
        }
    }
    for (size_t index = static_cast<size_t>(count); index < rays.occluded.size(); ++index) {
        EXPECT_EQ(rays.occluded[index], 9) << "answers past the last ray are not written";
        EXPECT_LT(rays.primitive[index], 0) << "and nothing is hit there";
    }
}

TEST(Queries, PacketsOfEveryCount) {
    for (const Isa isa : all_isas()) {
        const BuiltScene built = one_square(isa);
        for (int count = 0; count <= 33; ++count) {
            for (const Coherence coherence : both_ways)
                expect_packet(built, count, coherence);
        }
    }
}

TEST(Queries, AnEmptySceneIsMissedByAll) {
    SceneBuilder builder;
    const BuiltScene built = build(builder.take());
    for (const Coherence coherence : both_ways) {
        RayList rays;
        for (int i = 0; i < 20; ++i)
            rays.add({0, 0, 5}, {0, 0, -1});
        EXPECT_EQ(rays.intersect(built.accel, coherence, {true, false, 0}), 0);
        EXPECT_EQ(rays.occlude(built.accel, coherence), 0);
        for (int i = 0; i < 20; ++i) {
            EXPECT_FALSE(rays.hit(i));
            EXPECT_EQ(rays.occluded[static_cast<size_t>(i)], 0);
        }
    }
}

TEST(Queries, DegenerateTrianglesAreNeverHit) {
    SceneBuilder builder;
    builder.material({});
    Pcg32 random(3);
    Scene& scene = builder.scene();
    constexpr uint32_t count = 2000;
    for (uint32_t i = 0; i < count; ++i) {
        const Vec3f a = random_in_cube(random, 1.0F);
        const Vec3f b = i % 2 == 0 ? a : random_in_cube(random, 1.0F);
        for (const Vec3f& p : {a, b, a})
            scene.positions.insert(scene.positions.end(), {p.x, p.y, p.z});
        scene.indices.insert(scene.indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    }
    Primitive primitive;
    primitive.triangle_count = count;
    scene.primitives.push_back(primitive);
    const BuiltScene built = build(builder.take());
    for (const Coherence coherence : both_ways) {
        RayList rays;
        for (int i = 0; i < 20000; ++i) {
            const Vec3f origin = random_in_cube(random, 2.0F);
            rays.add(origin, random_unit(random));
        }
        EXPECT_EQ(rays.intersect(built.accel, coherence, {true, false, 0}), 0);
        for (int i = 0; i < rays.count(); ++i)
            ASSERT_FALSE(rays.hit(i)) << i;
    }
}

/// Two world squares, then two meshes of two and one squares; the instances stand in lines along x.
Scene numbered_scene() {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    for (const float z : {0.0F, 1.0F, 2.0F, 3.0F, 4.0F})
        add_square(builder, z, material);
    Scene scene = builder.take();
    scene.world_primitive_count = 2;
    scene.meshes = {{2, 2}, {4, 1}};
    for (int i = 0; i < 4; ++i) {
        Instance instance;
        instance.world_from_object = affine_cast<float>(scaling(1, 1, 1, {10.0 * (i + 1), 0, 0}));
        instance.object_from_world = affine_cast<float>(scaling(1, 1, 1, {-10.0 * (i + 1), 0, 0}));
        instance.mesh = i % 2;
        scene.instances.push_back(instance);
    }
    return scene;
}

TEST(Queries, IndicesOfInstancesPrimitivesAndTriangles) {
    const BuiltScene built = build(numbered_scene());
    struct Expected {
        float x, z;
        int32_t instance, primitive;
    };
    const Expected cases[] = {{0, 1.5F, -1, 1},
                              {0, 0.5F, -1, 0},
                              {10, 9, 0, 3},
                              {10, 2.5F, 0, 2},
                              {20, 9, 1, 4},
                              {30, 9, 2, 3},
                              {30, 2.5F, 2, 2},
                              {40, 9, 3, 4}};
    for (const Coherence coherence : both_ways) {
        RayList rays;
        for (const Expected& e : cases) {
            rays.add({e.x + 0.5F, -0.25F, e.z}, {0, 0, -1});  // lower right: triangle 0
            rays.add({e.x - 0.5F, 0.25F, e.z}, {0, 0, -1});   // upper left: triangle 1
        }
        rays.intersect(built.accel, coherence);
        for (int i = 0; i < rays.count(); ++i) {
            const auto index = static_cast<size_t>(i);
            const Expected& e = cases[i / 2];
            EXPECT_EQ(rays.instance[index], e.instance) << i;
            EXPECT_EQ(rays.primitive[index], e.primitive) << i;
            EXPECT_EQ(rays.triangle[index], i % 2) << i;
        }
        // Barycentrics weigh the second and third corner: (1,-1) and (1,1) of (0.5,-0.25).
        EXPECT_NEAR(rays.u[0], 0.375F, 1e-6F);
        EXPECT_NEAR(rays.v[0], 0.375F, 1e-6F);
    }
}

/// What a camera ray down -Z, or up +Z, sees: primitive or -1.
int32_t seen(const BuiltScene& built, bool from_above, Coherence coherence) {
    RayList rays;
    for (int i = 0; i < 5; ++i) {
        rays.add({0.3F, 0.1F * static_cast<float>(i), from_above ? 9.0F : -9.0F},
                 {0, 0, from_above ? -1.0F : 1.0F});
    }
    rays.intersect(built.accel, coherence, {true, false, 0});
    for (size_t i = 1; i < 5; ++i)
        EXPECT_EQ(rays.primitive[i], rays.primitive[0]);
    rays.occlude(built.accel, coherence);
    EXPECT_EQ(rays.occluded[0], 1) << "shadow rays see both sides";
    return rays.primitive[0];
}

TEST(Queries, CameraRaysPassSingleSidedBacks) {
    Material both_sides;
    both_sides.flags = material_double_sided;
    SceneBuilder builder;
    const int32_t single = builder.material({});
    const int32_t twofold = builder.material(both_sides);
    add_square(builder, -3, twofold);
    for (int i = 0; i < 6; ++i)
        add_square(builder, static_cast<float>(i), single, true);  // all face down
    add_square(builder, -1, single);
    const BuiltScene built = build(builder.take());
    EXPECT_EQ(seen(built, true, Coherence::coherent), 7) << "the only one that faces up";
    EXPECT_EQ(seen(built, false, Coherence::coherent), 0) << "double-sided";
    // Without culling the nearest counts.
    RayList rays;
    rays.add({0.3F, 0.2F, 9}, {0, 0, -1});
    rays.intersect(built.accel, Coherence::coherent);
    EXPECT_EQ(rays.primitive[0], 6);
}

TEST(Queries, CameraRaysMeetShapesBehindPassedBacks) {
    for (const Isa isa : all_isas()) {
        SceneBuilder builder;
        add_square(builder, 2, builder.material({}), true);
        Scene scene = builder.take();
        add_shape(scene, make_shape(ShapeKind::box, 1, 1, 1), 0);
        const BuiltScene built = build(std::move(scene), embree_isa_for(isa));
        RayList rays;
        for (int i = 0; i < 16; ++i)
            rays.add({-0.5F + 0.06F * static_cast<float>(i), 0.2F, 5}, {0, 0, -1});
        rays.intersect(built.accel, Coherence::coherent, {.culls_back_faces = true});
        for (int i = 0; i < 16; ++i) {
            ASSERT_TRUE(rays.hit(i));
            EXPECT_EQ(rays.primitive[static_cast<size_t>(i)], 1);
            EXPECT_EQ(rays.t[static_cast<size_t>(i)], 4);
        }
    }
}

TEST(Queries, OnlyBacksAreAMiss) {
    SceneBuilder builder;
    const int32_t single = builder.material({});
    for (int i = 0; i < 3; ++i)
        add_square(builder, static_cast<float>(i), single);
    const BuiltScene built = build(builder.take());
    EXPECT_EQ(seen(built, true, Coherence::coherent), 2);
    EXPECT_EQ(seen(built, false, Coherence::coherent), -1);
}

TEST(Queries, FrontAndBackInOnePlaneShowTheFront) {
    // A common way to model two-sided sheets: every triangle again, turned over.
    SceneBuilder builder;
    const int32_t single = builder.material({});
    add_square(builder, 0, single);
    add_square(builder, 0, single, true);
    const BuiltScene built = build(builder.take());
    EXPECT_EQ(seen(built, true, Coherence::coherent), 0);
    EXPECT_EQ(seen(built, false, Coherence::coherent), 1);
}

TEST(Queries, MirroredInstancesKeepTheirFront) {
    SceneBuilder builder;
    add_square(builder, 0, builder.material({}));
    const Scene square = builder.take();
    struct Case {
        Affined placing;
        bool up;
    };
    const Case cases[] = {{scaling(1, 1, 1), true},
                          {scaling(-1, 1, 1), true},
                          {scaling(2, -3, 1, {0, 0.5, 2}), true},
                          {scaling(1, 1, -1), false},
                          {scaling(-1, -1, -1), false},
                          {scaling(-1, 1, -1), false}};
    for (const Case& c : cases) {
        const BuiltScene built = build(instanced(square, {c.placing}));
        EXPECT_EQ(seen(built, true, Coherence::coherent), c.up ? 0 : -1);
        EXPECT_EQ(seen(built, false, Coherence::coherent), c.up ? -1 : 0);
    }
}

/// Leaves values where later calls keep their local variables.
[[gnu::noinline]] uint32_t soil_the_stack(uint32_t seed) {
    volatile uint32_t words[20000];
    for (uint32_t i = 0; i < 20000; ++i)
        words[i] = seed < 2 ? 0U - seed : hash_word(seed + i);
    return words[seed];
}

TEST(Queries, CoherentAndIncoherentRaysSeeTheSameInstances) {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, 8, builder.material({}));
    const Scene ball = builder.take();
    std::vector<Affined> placings;
    Pcg32 random(9);
    for (int i = 0; i < 30; ++i) {
        const Vec3f p = random_in_cube(random, 6.0F);
        placings.push_back(scaling(i % 2 == 0 ? -1 : 1, 0.5, 2, {p.x, p.y, p.z}));
    }
    RayList rays;
    for (int i = 0; i < 20000 / thorough; ++i) {
        const Vec3f target = random_in_cube(random, 6.0F);
        rays.add({0, 0, 20}, normalize(target - Vec3f{0, 0, 20}));
    }
    for (const Isa isa : all_isas()) {
        const BuiltScene built = build(instanced(ball, placings), embree_isa_for(isa));
        soil_the_stack(static_cast<uint32_t>(isa));
        rays.intersect(built.accel, Coherence::incoherent);
        const auto t = rays.t;
        const auto instance = rays.instance;
        const auto primitive = rays.primitive;
        rays.intersect(built.accel, Coherence::coherent);
        rays.occlude(built.accel, Coherence::coherent);
        int different = 0;
        for (size_t i = 0; i < static_cast<size_t>(rays.count()); ++i) {
            const bool same = primitive[i] == rays.primitive[i] &&
                              (primitive[i] < 0 || (instance[i] == rays.instance[i] &&
                                                    std::abs(t[i] - rays.t[i]) < 1e-4F * t[i]));
            different += same ? 0 : 1;
            EXPECT_EQ(rays.occluded[i] == 1, rays.primitive[i] >= 0) << i;
        }
        EXPECT_LE(different, 1);
    }
}

TEST(Queries, CoherentOcclusionByInstancesAlwaysComesBack) {
    const BuiltScene built = [] {
        SceneBuilder builder;
        add_square(builder, 0, builder.material({}));
        return build(instanced(builder.take(), {scaling(1, 1, 1)}));
    }();
    uint32_t soil = 0;
    for (uint32_t seed = 0; seed < 40; ++seed) {
        RayList rays;
        for (int i = 0; i < 5; ++i)
            rays.add({0.3F, 0.1F * static_cast<float>(i), 9}, {0, 0, -1});
        soil ^= soil_the_stack(seed);
        rays.occlude(built.accel, Coherence::coherent);
        for (size_t i = 0; i < 5; ++i)
            ASSERT_EQ(rays.occluded[i], 1);
    }
    EXPECT_NE(soil, 1U);
}

TEST(Queries, MemoryAndVersionAreReported) {
    const BuiltScene built = one_square();
    EXPECT_GT(built.accel.memory_bytes(), 0U);
    EXPECT_TRUE(built.accel.embree_version().starts_with("3.13.") ||
                built.accel.embree_version().starts_with("4."));
    Scene scene;
    const auto refused = Accel::build(scene, "no-such-isa");
    if (refused) {
        EXPECT_FALSE(refused->embree_version().empty());  // Embree ignores names it does not know
    } else {
        EXPECT_EQ(refused.error().id, "E-EMBREE");
    }
}

}  // namespace
}  // namespace obscura
