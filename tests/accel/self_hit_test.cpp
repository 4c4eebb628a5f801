// tests/accel/self_hit_test.cpp - rays that start at a hit leave it and stop at close surfaces.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"
#include "stages/wavefront.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace obscura {
namespace {

using namespace test;

SceneView view_of(const Scene& scene) {
    SceneView view;
    view.positions = scene.positions.data();
    view.indices = reinterpret_cast<const int32_t*>(scene.indices.data());
    view.attributes = scene.attributes.data();
    view.primitives = scene.primitives.data();
    view.instances = scene.instances.data();
    view.materials = scene.materials.data();
    return view;
}

struct Spawned {
    int rays = 0;
    int occluded = 0;
};

/// Shoots rays from random points of one box at random points of another; where they hit, the
/// stage for ambient occlusion starts rays, which are traced on.
class Shooter {
public:
    Shooter(const BuiltScene& built, Isa isa) : built_(built), stages_(stage_table_for(isa)) {}

    /// from(random) and at(random) give the ends of the first rays, in world space.
    template <typename From, typename At>
    Spawned shoot(int count, const From& from, const At& at) {
        Spawned sum;
        for (int done = 0; done < count; done += batch_size) {
            const PathColumns& p = work_.paths[0];
            for (int i = 0; i < batch_size; ++i) {
                const Vec3d origin = from(random_);
                const Vec3d direction = normalize(at(random_) - origin);
                p.ox[i] = static_cast<float>(origin.x);
                p.oy[i] = static_cast<float>(origin.y);
                p.oz[i] = static_cast<float>(origin.z);
                p.dx[i] = static_cast<float>(direction.x);
                p.dy[i] = static_cast<float>(direction.y);
                p.dz[i] = static_cast<float>(direction.z);
                p.tr[i] = p.tg[i] = p.tb[i] = 1.0F;
                p.pdf[i] = p.cone_width[i] = p.cone_spread[i] = 0.0F;
                p.slot[i] = static_cast<uint32_t>(i);
                p.key[i] = random_.next_uint();
                p.sample[i] = 0U;
            }
            trace_batch(sum);
        }
        return sum;
    }

private:
    void trace_batch(Spawned& sum) {
        const PathColumns& p = work_.paths[0];
        built_.accel.intersect({p.ox, p.oy, p.oz, p.dx, p.dy, p.dz, nullptr, p.key, batch_size},
                               work_.hits,
                               Coherence::incoherent,
                               {});
        BatchSettings batch;
        batch.ao_distance = 3e38F;
        const int shadows = stages_.shade_ao(
            view_of(*built_.scene),
            batch,
            batch_size,
            {p, work_.hits, work_.misses, work_.paths[1], work_.shadows, work_.samples});
        const ShadowColumns& s = work_.shadows;
        built_.accel.occluded({s.ox, s.oy, s.oz, s.dx, s.dy, s.dz, s.tfar, s.slot, shadows},
                              work_.occluded.data(),
                              Coherence::incoherent,
                              {1});
        sum.rays += shadows;
        sum.occluded += static_cast<int>(
            std::count(work_.occluded.begin(), work_.occluded.begin() + shadows, uint8_t{1}));
    }

    const BuiltScene& built_;
    const StageTable& stages_;
    Workspace work_;
    Pcg32 random_{11};
};

Vec3d random_point(Pcg32& random, double half) {
    const double x = (2 * random.next_double() - 1) * half;
    const double y = (2 * random.next_double() - 1) * half;
    return {x, y, (2 * random.next_double() - 1) * half};
}

Affined turned(Affined a) {
    Affined turn;  // about an odd axis, by columns of a rotation
    const double rows[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6}};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            turn.m[r][c] = rows[r][c];
    }
    return compose(a, turn);
}

/// Placement of a unit-sized object: scale, and a translation by some of its own sizes.
struct Placing {
    const char* name;
    Affined world_from_object;
    double size;
};

std::vector<Placing> placings() {
    std::vector<Placing> out;
    for (const double scale : {1e-3, 1.0, 30.0, 1e5}) {
        for (const double moved : {0.0, 1.0, 100.0}) {
            const Vec3d to{moved * scale, -0.3 * moved * scale, 0.77 * moved * scale};
            out.push_back({"even", scaling(scale, scale, scale, to), scale});
            out.push_back(
                {"turned, uneven", turned(scaling(scale, 3 * scale, 0.2 * scale, to)), scale});
            out.push_back({"mirrored", turned(scaling(-scale, 0.5 * scale, 2 * scale, to)), scale});
        }
    }
    return out;
}

enum class Form { world, instance };

/// The object placed by an instance, or its vertices moved into the world.
BuiltScene place(Scene object, const Affined& placing, Form form) {
    if (form == Form::instance) return build(instanced(std::move(object), {placing}));
    for (size_t i = 0; i + 7 <= object.positions.size(); i += 3) {
        float* p = &object.positions[i];
        const Vec3d moved = transform_point(placing, Vec3d{p[0], p[1], p[2]});
        p[0] = static_cast<float>(moved.x);
        p[1] = static_cast<float>(moved.y);
        p[2] = static_cast<float>(moved.z);
    }
    return build(std::move(object));
}

std::string describe(const Placing& p, Form form, Isa isa) {
    return std::string(form == Form::instance ? "instance " : "world ") + p.name + ", size " +
           std::to_string(p.size) + ", moved " + std::to_string(p.world_from_object.m[0][3]) +
           ", isa " + stage_table_for(isa).isa;
}

/// Spawns rays on an object that cannot shade itself; none of them may find anything.
template <typename At>
void expect_no_self_hits(const Scene& object, const At& at_object) {
    constexpr int rays = 1 << 14;
    int spawned = 0;
    for (const Placing& p : placings()) {
        for (const Form form : {Form::world, Form::instance}) {
            const BuiltScene built = place(object, p.world_from_object, form);
            for (const Isa isa : all_isas()) {
                const auto to_world = [&](const Vec3d& v) {
                    return transform_point(p.world_from_object, v);
                };
                const Spawned s =
                    Shooter(built, isa)
                        .shoot(
                            rays / thorough,
                            [&](Pcg32& random) {
                                return to_world(normalize(random_point(random, 1)) * 4.0);
                            },
                            [&](Pcg32& random) { return to_world(at_object(random)); });
                spawned += s.rays;
                EXPECT_EQ(s.occluded, 0) << "of " << s.rays << ", " << describe(p, form, isa);
            }
        }
    }
    EXPECT_GT(spawned, 24 * rays / thorough / 2);
}

Scene flat_quad() {
    SceneBuilder builder;
    builder.quad({-1, -1, 0.1F}, {2, 0.1F, 0.3F}, {-0.2F, 2, 0.4F}, builder.material({}));
    return builder.take();
}

TEST(SelfHit, FlatSurfacesOfAnySizeAnywhere) {
    expect_no_self_hits(flat_quad(), [](Pcg32& random) {
        const double x = random.next_double();
        const double y = random.next_double();
        return Vec3d{-1 + 2 * x - 0.2 * y, -1 + 0.1 * x + 2 * y, 0.1 + 0.3 * x + 0.4 * y};
    });
}

TEST(SelfHit, ConvexSurfacesOfAnySizeAnywhere) {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, 6, builder.material({}), false, true);
    expect_no_self_hits(builder.take(), [](Pcg32& random) { return random_point(random, 0.5); });
}

/// Two parallel sheets, a ten-thousandth of their size apart.
Scene thin_wall() {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    builder.quad({-0.5F, -0.5F, 0}, {1, 0, 0}, {0, 1, 0}, material);
    builder.quad({-40, -40, 1e-4F}, {80, 0, 0}, {0, 80, 0}, material);
    return builder.take();
}

TEST(SelfHit, AThinWallStillOccludes) {
    int spawned = 0;
    for (const double scale : {1e-3, 1.0, 1e5}) {
        for (const double moved : {0.0, 1.0, 10.0}) {
            const Affined placing =
                scaling(scale, scale, scale, {moved * scale, 0.5 * moved * scale, 0});
            for (const Form form : {Form::world, Form::instance}) {
                const BuiltScene built = place(thin_wall(), placing, form);
                for (const Isa isa : all_isas()) {
                    // From between the sheets down to the small one, then up again.
                    const Spawned s =
                        Shooter(built, isa)
                            .shoot((1 << 14) / thorough,
                                   [&](Pcg32& random) {
                                       const Vec3d v = random_point(random, 0.4);
                                       return transform_point(placing, Vec3d{v.x, v.y, 0.5e-4});
                                   },
                                   [&](Pcg32& random) {
                                       const Vec3d v = random_point(random, 0.4);
                                       return transform_point(placing, Vec3d{v.x, v.y, -2.0});
                                   });
                    EXPECT_EQ(s.occluded, s.rays)
                        << describe({"thin wall", placing, scale}, form, isa);
                    spawned += s.rays;
                }
            }
        }
    }
    EXPECT_GT(spawned, 18 * (1 << 14) / thorough / 2);
}

}  // namespace
}  // namespace obscura
