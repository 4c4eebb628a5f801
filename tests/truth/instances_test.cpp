// tests/truth/instances_test.cpp - a stretched instance has the normals of the same mesh in place.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "support/thin_wall_scenes.h"

namespace obscura::test {
namespace instances_truth {

constexpr int side = 48;

/// A flattened, sheared ball in the mirror: normals at the corners of a face change their lengths
/// by factors up to 5.
constexpr Affinef flattened = {{{-1, 0, 0.3f, 0.1f}, {0, 0.2f, 0, -0.2f}, {0, 0, 0.7f, 0}}};

/// A ball of few faces with tangents around its axis.
Scene coarse_ball() {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1, 3, builder.material({}));
    Scene scene = builder.take();
    const size_t vertices = scene.positions.size() / 3;
    scene.primitives[0].tangent_base = static_cast<int32_t>(scene.attributes.size());
    for (size_t i = 0; i < vertices; ++i) {
        const float x = scene.positions[3 * i], z = scene.positions[3 * i + 2];
        const Vec3f around = normalize(Vec3f{-z, 0, x + 1e-6f});
        scene.attributes.insert(scene.attributes.end(), {around.x, around.y, around.z, 1});
    }
    scene.attributes.resize(scene.attributes.size() + 4);  // gathers read four words
    return scene;
}

void store(const Vec3f& v, float* to) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

/// Moves vertices, normals and tangents one by one.
Scene in_place(const Affinef& world) {
    Scene scene = coarse_ball();
    const Affinef object = inverse(world);
    const Primitive& primitive = scene.primitives[0];
    for (size_t i = 0; i < scene.positions.size() / 3; ++i) {
        float* p = &scene.positions[3 * i];
        float* n = &scene.attributes[static_cast<size_t>(primitive.normal_base) + 3 * i];
        float* t = &scene.attributes[static_cast<size_t>(primitive.tangent_base) + 4 * i];
        store(transform_point(world, Vec3f{p[0], p[1], p[2]}), p);
        store(normalize(transform_normal(object, Vec3f{n[0], n[1], n[2]})), n);
        store(normalize(transform_vector(world, Vec3f{t[0], t[1], t[2]})), t);
    }
    for (size_t i = 0; i + 2 < scene.indices.size() && determinant(world) < 0; i += 3)
        std::swap(scene.indices[i + 1], scene.indices[i + 2]);
    return scene;
}

std::vector<FilmLayer> layers_seen(Scene scene) {
    RenderOptions options;
    options.width = options.height = side;
    options.samples_per_pixel = 1;
    const std::vector<std::string> names = {"normal", "tangent"};
    options.layers = layers_of(names, 6).value();
    const Camera camera = look_at({1.5f, 1, 2}, {0, -0.1f, 0}, 0.8f, side, side);
    return render_scene(std::move(scene), {}, camera, options).film.layers;
}

/// The largest angle between two pictures of unit vectors, in degrees.
double largest_angle(const FilmLayer& a, const FilmLayer& b) {
    double largest = 0;
    size_t seen = 0;
    for (size_t i = 0; i + 2 < a.pixels.size(); i += 3) {
        const Vec3d u{a.pixels[i], a.pixels[i + 1], a.pixels[i + 2]};
        const Vec3d v{b.pixels[i], b.pixels[i + 1], b.pixels[i + 2]};
        if (dot(u, u) < 0.5 && dot(v, v) < 0.5) continue;  // the background in both
        ++seen;
        largest = std::max(largest, std::atan2(length(cross(u, v)), dot(u, v)));
    }
    EXPECT_GT(seen, 200U);
    return largest * 180 / pi_d;
}

void expect_alike(Scene instanced) {
    const std::vector<FilmLayer> expected = layers_seen(in_place(flattened));
    const std::vector<FilmLayer> found = layers_seen(std::move(instanced));
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
        EXPECT_LT(largest_angle(found[i], expected[i]), 0.05) << found[i].layer.name;
    }
}

TEST(Instances, NormalsAndTangentsAreTurnedBeforeTheyAreInterpolated) {
    Scene scene = coarse_ball();
    place_last(scene, {flattened});
    expect_alike(std::move(scene));
}

TEST(Instances, SoAreThoseOfInstancesThatMove) {
    Scene scene = coarse_ball();
    place_last(scene, {flattened, flattened});
    // Only what it moves between counts.
    scene.instances[0].world_from_object = scene.instances[0].object_from_world = Affinef{};
    expect_alike(std::move(scene));
}

}  // namespace instances_truth
}  // namespace obscura::test
