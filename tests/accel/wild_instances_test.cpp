// tests/accel/wild_instances_test.cpp - instances of every magnitude: no ray may end the process.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"
#include "accel/ray_recording.h"
#include "accel/reference_kernels.h"
#include "scene/ray_reach.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace obscura::test {
namespace {

constexpr double farthest_position = 1e18;  ///< readers of files leave out positions beyond it

class WildScenes {
public:
    explicit WildScenes(uint64_t seed) : random_(seed) {}

    /// One to four instances of a triangle mesh and a sphere, in a world of any size.
    Scene make() {
        SceneBuilder builder;
        const int32_t material = builder.material({});
        world_ = power(-6, 17);
        const auto size = static_cast<float>(chance(2) ? world_ : power(-20, 17));
        builder.quad({-size, -size, 0}, {2 * size, 0, 0}, {0, 2 * size, 0.1F * size}, material);
        Scene scene = builder.take();
        const auto radius = static_cast<float>(chance(2) ? 1.0 : power(-9, 9));
        scene.meshes = {{0, 1}, {1, 1}};
        scene.primitives.push_back(
            shape_primitive(scene, make_shape(ShapeKind::sphere, radius), material));
        scene.world_primitive_count = 0;
        scene.bounds = {};
        scene.motion.steps = chance(3) ? 2 + static_cast<int32_t>(random_.next_uint() % 4) : 1;
        boxes_[0] = {{-size, -size, 0}, {size, size, 0.1F * size}};
        boxes_[1] = {{-radius, -radius, -radius}, {radius, radius, radius}};
        const uint32_t count = 1 + random_.next_uint() % 4;
        for (uint32_t i = 0; i < count; ++i)
            add_instance(scene);
        return scene;
    }

    bool chance(uint32_t of) { return random_.next_uint() % of == 0; }
    double power(double low, double high) {
        return std::pow(10.0, low + (high - low) * random_.next_double());
    }
    double sign() { return chance(2) ? 1 : -1; }
    Pcg32& random() { return random_; }

private:
    Affined place();
    Affined next_place(const Affined& before);
    void add_instance(Scene& scene);

    Pcg32 random_;
    double world_ = 1;
    Bounds boxes_[2];
};

/// Translation, rotation and scale, or any matrix; often of sizes that fit each other.
Affined WildScenes::place() {
    Affined out;
    const double base = chance(2) ? power(-20, 13) : power(-3, 3);
    const bool is_trs = !chance(4);
    const bool is_uniform = chance(2);
    const double angle = chance(3) ? 0 : 2 * pi_d * random_.next_double();
    for (int c = 0; c < 3; ++c) {
        const double scale = is_uniform ? base : sign() * base * power(-20, 6);
        for (int r = 0; r < 3; ++r) {
            const double turn = r == 2 || c == 2 ? (r == c ? 1 : 0)
                                : r == c         ? std::cos(angle)
                                                 : (r < c ? -1 : 1) * std::sin(angle);
            out.m[r][c] = is_trs ? scale * turn : sign() * base * power(-8, 2);
        }
    }
    for (auto& row : out.m)
        row[3] = chance(3) ? 0 : sign() * (chance(2) ? world_ : power(-20, 18.2));
    return out;
}

/// A later placement: mirrored, rotated, shrunk, or somewhere else.
Affined WildScenes::next_place(const Affined& before) {
    Affined out = before;
    const uint32_t way = random_.next_uint() % 4;
    if (way == 0) return place();
    const double factor = way == 1 ? -1 : way == 2 ? power(-12, 1) : 1;
    for (int r = 0; r < 2; ++r) {
        for (int c = 0; c < 3; ++c)
            out.m[r][c] *= factor;
    }
    out.m[0][3] += world_ * random_.next_double();
    return out;
}

/// Leaves out what file readers do: instances that are not finite or out of range at some time.
void WildScenes::add_instance(Scene& scene) {
    Instance instance;
    instance.mesh = chance(2) ? 1 : 0;
    const bool motion = scene.motion.steps > 1 && chance(2);
    std::vector<Affinef> places;
    Affined at = place();
    const Affined first = at;
    Bounds all = scene.bounds;
    for (int32_t step = 0; step < (motion ? scene.motion.steps : 1); ++step) {
        if (step > 0) at = next_place(at);
        places.push_back(affine_cast<float>(at));
        const Bounds& box = boxes_[instance.mesh];
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3d p = transform_point(at,
                                            {(corner & 1) != 0 ? box.high.x : box.low.x,
                                             (corner & 2) != 0 ? box.high.y : box.low.y,
                                             (corner & 4) != 0 ? box.high.z : box.low.z});
            if (!(max_component(abs(p)) <= farthest_position)) return;
            const Vec3f v{
                static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
            all.low = -max3(-all.low, -v);
            all.high = max3(all.high, v);
        }
    }
    instance.world_from_object = places.front();
    instance.object_from_world = affine_cast<float>(inverse(first));
    instance.mirrored = determinant(first) < 0 ? 1 : 0;
    if (motion) {
        instance.motion = static_cast<int32_t>(scene.motion.instances.size());
        scene.motion.instances.insert(scene.motion.instances.end(), places.begin(), places.end());
    }
    scene.bounds = all;
    scene.instances.push_back(instance);
}

/// Rays of an image and others, with a time each.
struct WildRays {
    std::vector<float> columns[8];
    std::vector<uint32_t> key;
    int count = 0;

    void add(const Vec3f& origin, const Vec3f& direction, float tfar, float time) {
        const float numbers[] = {
            origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, tfar, time};
        for (size_t c = 0; c < 8; ++c)
            columns[c].push_back(numbers[c]);
        key.push_back(static_cast<uint32_t>(count++));
    }
    RayColumns view() {
        for (std::vector<float>& column : columns)
            column.resize(static_cast<size_t>(count) + 16, 0.5F);
        key.resize(static_cast<size_t>(count) + 16);
        const auto& c = columns;
        return {c[0].data(),
                c[1].data(),
                c[2].data(),
                c[3].data(),
                c[4].data(),
                c[5].data(),
                c[6].data(),
                key.data(),
                count,
                c[7].data()};
    }
};

WildRays rays_for(const Scene& scene, WildScenes& wild) {
    Pcg32& random = wild.random();
    WildRays rays;
    const Vec3f middle = 0.5F * (scene.bounds.low + scene.bounds.high);
    const Vec3f half = 0.5F * (scene.bounds.high - scene.bounds.low);
    for (int i = 0; i < 32; ++i) {
        const Vec3f spot = random_in_cube(random, i % 2 == 0 ? 1.0F : 3.0F);
        Vec3f origin = middle + Vec3f{spot.x * half.x, spot.y * half.y, spot.z * half.z};
        Vec3f aim = middle - origin;
        if (i % 4 >= 2) {  // at the origin of an instance
            const Instance& one = scene.instances[random.next_uint() % scene.instances.size()];
            const auto& m = one.world_from_object.m;
            aim = Vec3f{m[0][3], m[1][3], m[2][3]} - origin;
        }
        const float longest = max_component(abs(aim));
        Vec3f direction = longest > 0 ? normalize(aim * (1.0F / longest)) : Vec3f{0, 0, 1};
        if (i % 8 == 5) direction = {0, i % 16 == 5 ? 1.0F : -1.0F, 0};
        if (i % 8 == 7) direction = random_unit(random);
        if (i == 30) origin.y = wild.chance(2) ? NAN : 1.5e18F;
        if (i == 31) direction = {1e-42F, wild.chance(2) ? INFINITY : 1e18F, 0};
        const float times[] = {0.0F, 0.5F, 1.0F, 0.25F};
        const float time = i % 3 == 0 ? random.next_float() : times[i % 4];
        rays.add(origin, direction, i % 5 == 0 ? 3e38F : 2.0F * max_component(half), time);
    }
    return rays;
}

/// Runs every kind of query; returns the number of hits.
int ask_all(const Scene& scene, WildScenes& wild, bool thoroughly) {
    auto accel = Accel::build(scene, "");
    EXPECT_TRUE(accel);
    WildRays rays = rays_for(scene, wild);
    const RayColumns columns = rays.view();
    const size_t padded = rays.columns[0].size();
    std::vector<float> t(padded), u(padded), v(padded);
    std::vector<int32_t> instance(padded), primitive(padded), triangle(padded);
    const HitColumns hits{
        t.data(), u.data(), v.data(), instance.data(), primitive.data(), triangle.data()};
    std::vector<uint8_t> occluded(padded);
    int found = 0;
    RayRecording recording;
    recording.threads.push_back(std::make_unique<RayRecorder>(accel->ray_reach()));
    RayRecorder& recorder = *recording.threads.back();
    for (const Coherence coherence : both_ways) {
        SeeThrough see_through;
        see_through.culls_back_faces = coherence == Coherence::coherent;
        EXPECT_LT(accel->intersect(columns, hits, coherence, see_through), rays.count);
        recorder.add_hits(columns, hits, see_through);
        for (size_t i = 0; i < static_cast<size_t>(rays.count); ++i) {
            if (primitive[i] < 0) continue;
            ++found;
            EXPECT_TRUE(std::isfinite(t[i]) && t[i] >= 0) << t[i];
        }
        accel->occluded(columns, occluded.data(), coherence);
        recorder.add_shadows(columns, occluded.data(), {});
    }
    if (!thoroughly) return found;
    for (const RayKind kind : {RayKind::camera, RayKind::shadow}) {
        for (const ReplayMode mode :
             {ReplayMode::single, ReplayMode::packets, ReplayMode::coherent_packets})
            accel->replay(recording, kind, mode);
    }
    for (const std::string& isa : embree_isas()) {
        for (const bool robust : {false, true}) {
            const auto kernels = ReferenceKernels::build(scene, {.isa = isa, .robust = robust});
            EXPECT_TRUE(kernels);
            for (const int width : {1, 4, 8, 16}) {
                kernels->intersect(columns, hits, width);
                kernels->occluded(columns, occluded.data(), width);
            }
        }
    }
    const auto counting = Accel::build_counting(scene, "");
    EXPECT_TRUE(counting);
    counting->count_tests(columns, t.data());
    return found;
}

/// Embree's assertions, where its build has them, end the process at a ray that is not finite in
/// an instance's space. OBSCURA_WILD_SCENES asks for more of them.
TEST(WildInstances, NoRayEndsTheProcess) {
    const char* wished = std::getenv("OBSCURA_WILD_SCENES");
    const int scenes = wished != nullptr ? std::atoi(wished) : 10000 / thorough;
    WildScenes wild(18);
    int drawn = 0;
    int left_out = 0;
    int halted = 0;
    int hit = 0;
    for (int i = 0; i < scenes; ++i) {
        Scene scene = wild.make();
        const UnreachedInstances unreached = leave_out_unreached(scene);
        left_out += static_cast<int>(unreached.left_out.size());
        halted += static_cast<int>(unreached.halted.size());
        drawn += static_cast<int>(scene.instances.size());
        if (!scene.instances.empty()) hit += ask_all(scene, wild, i % 100 == 0);
    }
    EXPECT_GT(drawn, scenes / 4);
    EXPECT_GT(left_out, scenes / 10);
    EXPECT_GT(halted, scenes / 100);
    EXPECT_GT(hit, 3 * scenes);
}

/// What no reader has removed is refused ray by ray.
TEST(WildInstances, RaysThatAnInstanceCannotTakeAreRefused) {
    WildScenes wild(81);
    for (int i = 0; i < 1000 / thorough; ++i) {
        const Scene scene = wild.make();
        if (scene.instances.empty()) continue;
        const auto accel = Accel::build(scene, "");
        ASSERT_TRUE(accel);
        WildRays rays = rays_for(scene, wild);
        const RayColumns columns = rays.view();
        std::vector<uint8_t> occluded(rays.columns[0].size());
        accel->occluded(columns, occluded.data(), Coherence::incoherent);
    }
}

}  // namespace
}  // namespace obscura::test
