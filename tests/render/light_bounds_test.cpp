// tests/render/light_bounds_test.cpp - which lights the tree chooses, and that it misses none.
// SPDX-License-Identifier: Apache-2.0
#include "render/light_bounds.h"

#include "light/punctual_sample.h"
#include "light/shape_light.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/shape_scenes.h"
#include <algorithm>
#include <cmath>

namespace obscura::test {
namespace {

Vec3f point_within(Pcg32& random, float size) {
    const auto one = [&] { return size * (2 * random.next_float() - 1); };
    const float x = one();
    const float y = one();
    return {x, y, one()};
}

PunctualLight random_bulb(Pcg32& random, size_t number) {
    PunctualLight light;
    const Vec3f place = point_within(random, 2);
    const Vec3f axis = normalize(point_within(random, 1));
    std::copy_n(&place.x, 3, light.position);
    std::copy_n(&axis.x, 3, light.direction);
    std::fill_n(light.intensity, 3, 0.1f + random.next_float());
    if (number % 2 == 0) return light;
    light.type = static_cast<int32_t>(PunctualType::spot);
    const float outer = std::cos(0.1f + 1.2f * random.next_float());
    light.spot_scale = 1 / (1 - outer) + 1;
    light.spot_on_axis = (1 - outer) * light.spot_scale;
    return light;
}

/// Triangles of one side and of two, 20 points and spots, and as many spheres and disks as asked.
Scene many_lamps(int triangles, uint64_t seed, int shapes = 0) {
    SceneBuilder builder;
    Pcg32 random(seed);
    const auto lamp_of = [&](bool two_sided) {
        Material lamp;
        std::fill_n(lamp.emission, 3, std::exp2(4 * random.next_float()));
        if (two_sided) lamp.flags = material_double_sided;
        return builder.material(lamp);
    };
    for (int i = 0; i < triangles; i += 2) {
        const int32_t lamp = lamp_of(i % 4 == 0);
        const Vec3f place = point_within(random, 2);
        const Vec3f side = point_within(random, 0.3f);
        builder.quad(place, side, point_within(random, 0.3f), lamp);
    }
    std::vector<int32_t> lamps;
    for (int i = 0; i < shapes; ++i)
        lamps.push_back(lamp_of(i % 4 == 1));
    Scene scene = builder.take();
    for (size_t i = 0; i < 20; ++i)
        scene.lights.push_back(random_bulb(random, i));
    for (size_t i = 0; i < lamps.size(); ++i) {
        ShapeRecord record = make_shape(i % 2 == 0 ? ShapeKind::sphere : ShapeKind::disk,
                                        0.05f + 0.3f * random.next_float());
        const Vec3f place = point_within(random, 2);
        std::copy_n(&place.x, 3, record.centre);
        add_shape(scene, record, lamps[i]);
    }
    return scene;
}

Vec3d in_double(const float* at) {
    return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

/// A place on a light, and where it shines: its normal; none shines in all directions.
struct ShiningPlace {
    Vec3d place;
    Vec3d normal{0, 0, 0};
    bool two_sided = false;
};

ShiningPlace place_on(const TriangleLight& light, Pcg32& random) {
    double x = random.next_double();
    double y = random.next_double();
    if (x + y > 1) {
        x = 1 - x;
        y = 1 - y;
    }
    const Vec3d e1 = in_double(light.e1);
    const Vec3d e2 = in_double(light.e2);
    return {in_double(light.p0) + e1 * x + e2 * y, normalize(cross(e1, e2)), light.two_sided != 0};
}

ShiningPlace place_on(const ShapeLight& light, Pcg32& random) {
    const bool round = light.kind == static_cast<int32_t>(ShapeLightKind::sphere);
    const double turn = 2 * pi_d * random.next_double();
    if (!round) {
        const double out = random.next_double();
        const Vec3d along =
            in_double(light.x) * std::cos(turn) + in_double(light.z) * std::sin(turn);
        return {in_double(light.centre) + along * out, in_double(light.y), light.two_sided != 0};
    }
    const double z = 2 * random.next_double() - 1;
    const double s = std::sqrt(1 - z * z);
    const Vec3d normal{s * std::cos(turn), s * std::sin(turn), z};
    const double radius = static_cast<double>(light.radius);
    return {in_double(light.centre) + normal * radius, normal, light.two_sided != 0};
}

/// Whether light from there arrives at a point on the normal's side, if nothing is between.
bool arrives(const ShiningPlace& from, const LitPoint<float>& at) {
    const Vec3d way = from.place - in_double(&at.position.x);
    const double emitted = -dot(from.normal, way);
    const bool open = dot(at.normal, at.normal) <= 0;
    return (emitted > 0 || (from.two_sided && emitted < 0)) &&
           (open || dot(in_double(&at.normal.x), way) > 0);
}

double by_tree(const LightView& lights, const LitPoint<float>& at, int32_t light) {
    const int32_t leaf = lights.tree.leaf_of_light[light];
    return leaf < 0 ? 0.0
                    : static_cast<double>(
                          light_tree_probability<float>(lights.tree, at, leaf, leaf >= 0));
}

/// Lights of a scene that shine upon a point though the tree never chooses them; `arrived` counts
/// those that shine upon it.
int missed_lights(const LightTable& table, const LitPoint<float>& at, Pcg32& random, int& arrived) {
    const LightView lights = table.view();
    int missed = 0;
    int32_t number = 0;
    const auto note = [&](bool shines) {
        arrived += shines ? 1 : 0;
        missed += shines && !(by_tree(lights, at, number) > 0) ? 1 : 0;
    };
    for (; number < lights.punctual_count; ++number) {
        const auto s = sample_punctual<float>(lights.punctual, number, at.position);
        const bool open = dot(at.normal, at.normal) <= 0;
        note(s.irradiance.x > 0 && (open || dot(s.direction, at.normal) > 0));
    }
    const auto try_places = [&](const auto& light) {
        for (int k = 0; k < 8; ++k)
            note(arrives(place_on(light, random), at));
        ++number;
    };
    std::for_each(table.triangles.begin(), table.triangles.end(), try_places);
    std::for_each(table.shapes.begin(), table.shapes.end(), try_places);
    return missed;
}

TEST(LightBounds, EveryLightThatContributesMayBeChosen) {
    Pcg32 random(2);
    for (const int triangles : {0, 16, 200}) {
        Scene scene = many_lamps(triangles, static_cast<uint64_t>(triangles), 30);
        const LightTable table = make_light_table(scene, nullptr);
        ASSERT_EQ(table.shapes.size(), 30U);
        ASSERT_EQ(table.tree.light_of_leaf.size(), static_cast<size_t>(50 + triangles));
        int arrived = 0;
        int missed = 0;
        for (int k = 0; k < 300; ++k) {
            const Vec3f place = point_within(random, k % 3 == 0 ? 20.0f : 3.0f);
            const Vec3f normal = normalize(point_within(random, 1));
            missed += missed_lights(table, {place, normal}, random, arrived);
            missed += missed_lights(table, {place, {0, 0, 0}}, random, arrived);
            // On a light itself, and close to one.
            const float* lamp = table.shapes[static_cast<size_t>(k % 30)].centre;
            const Vec3f near{lamp[0], lamp[1], lamp[2] + 1e-3f * static_cast<float>(k)};
            missed += missed_lights(table, {near, normal}, random, arrived);
        }
        EXPECT_GT(arrived, 50000);
        EXPECT_EQ(missed, 0);
    }
}

TEST(LightBounds, LightsThatMoveMayBeChosenAllTheirWay) {
    Scene scene = many_lamps(0, 5);
    scene.motion.steps = 2;
    Pcg32 random(6);
    for (const PunctualLight& light : scene.lights) {
        scene.motion.lights.push_back(light);
        PunctualLight moved = random_bulb(random, 0);
        moved.type = light.type;
        moved.spot_scale = light.spot_scale;
        moved.spot_on_axis = light.spot_on_axis;
        scene.motion.lights.push_back(moved);
    }
    const LightTable table = make_light_table(scene, nullptr);
    const LightView lights = table.view();
    ASSERT_EQ(lights.tree.leaves, 20);
    int arrived = 0;
    for (int k = 0; k < 2000; ++k) {
        const LitPoint<float> at{point_within(random, 3), normalize(point_within(random, 1))};
        for (int32_t i = 0; i < 20; ++i) {
            const auto record = [&](int32_t step) {
                return read_punctual<float>(scene.motion.lights.data(), 2 * i + step, false);
            };
            const auto s = sample_punctual<float>(
                blend(record(0), record(1), random.next_float()), at.position, {});
            if (!(s.irradiance.x > 0) || !(dot(s.direction, at.normal) > 0)) continue;
            ++arrived;
            EXPECT_GT(by_tree(lights, at, i), 0);
        }
    }
    EXPECT_GT(arrived, 5000);
}

TEST(LightBounds, FewLightsAndThoseWithoutPlaceAreLeftToTheTable) {
    const auto tree_of = [](Scene scene) {
        return make_light_table(scene, nullptr).tree.nodes.size();
    };
    Scene scene = many_lamps(0, 1);
    EXPECT_EQ(tree_of(scene), 19U);
    scene.lights.resize(min_tree_lights - 1);
    EXPECT_EQ(tree_of(scene), 0U);
    scene.lights.resize(200);
    for (PunctualLight& light : scene.lights)
        light.type = static_cast<int32_t>(PunctualType::directional);
    EXPECT_EQ(tree_of(scene), 0U) << "they have no place";
}

TEST(LightBounds, TheTableChoosesBetweenTheTreeAndLightsWithoutPlace) {
    Scene scene = many_lamps(40, 3);
    PunctualLight sun;
    sun.type = static_cast<int32_t>(PunctualType::directional);
    scene.lights.push_back(sun);
    const ImageRgb32f image = *constant_environment(0.5f);
    const EnvironmentTable sky =
        EnvironmentTable::create({image.width, image.height, image.pixels.data()}, 1, 0).value();
    const LightTable table = make_light_table(scene, &sky);
    const LightView lights = table.view();
    ASSERT_EQ(lights.count, 21 + 40 + 1);
    EXPECT_EQ(lights.tree.leaves, 20 + 40);
    EXPECT_EQ(lights.tree.leaf_of_light[20], -1) << "the sun";
    EXPECT_EQ(lights.tree.leaf_of_light[61], -1) << "the sky";
    EXPECT_NEAR(lights.tree.share + lights.select_pdf[20] + lights.environment_select, 1, 1e-6);
    EXPECT_GT(lights.select_pdf[20], 0);
    EXPECT_EQ(lights.tree.first_random + lights.tree.randoms, 1 << 30);
    EXPECT_NEAR(lights.tree.randoms * 0x1p-30, lights.tree.share, 1e-6);
    for (int32_t i = 0; i < lights.triangle_count; ++i)
        EXPECT_NEAR(lights.triangles[i].pdf_area * lights.triangles[i].area, 1, 1e-5);
}

}  // namespace
}  // namespace obscura::test
