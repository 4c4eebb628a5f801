// tests/support/shape_scenes.h - scenes with analytic shapes in memory, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include "support/scene_builder.h"
#include <algorithm>
#include <limits>
#include <vector>

namespace obscura::test {

inline ShapeRecord make_shape(ShapeKind kind, float a, float b = 0, float c = 0) {
    ShapeRecord record;
    record.kind = static_cast<int32_t>(kind);
    record.size[0] = a;
    record.size[1] = b;
    record.size[2] = c;
    return record;
}

inline Primitive shape_primitive(Scene& scene, const ShapeRecord& record, int32_t material) {
    Primitive primitive;
    primitive.first_triangle = static_cast<int32_t>(scene.shapes.size());
    primitive.triangle_count = 1;
    primitive.material = material;
    primitive.tangent_base = 0;
    primitive.uv_base[0] = 0;
    primitive.geometry = static_cast<int32_t>(GeometryKind::shapes);
    scene.shapes.push_back(record);
    return primitive;
}

/// Adds a shape in world space to a scene that has no instances yet.
inline void add_shape(Scene& scene, const ShapeRecord& record, int32_t material) {
    Primitive primitive = shape_primitive(scene, record, material);
    primitive.node = static_cast<int32_t>(scene.primitives.size());
    scene.primitives.push_back(primitive);
    ++scene.world_primitive_count;
    const ShapeBox box = shape_bounds(record);
    if (is_unbounded(record)) return;
    scene.bounds.low = {std::min(scene.bounds.low.x, box.low.x),
                        std::min(scene.bounds.low.y, box.low.y),
                        std::min(scene.bounds.low.z, box.low.z)};
    scene.bounds.high = max3(scene.bounds.high, box.high);
}

/// Adds a shape that an instance places; after all shapes in world space.
inline void add_shape(Scene& scene,
                      const ShapeRecord& record,
                      int32_t material,
                      const Affined& placing) {
    Instance instance;
    instance.world_from_object = affine_cast<float>(placing);
    instance.object_from_world =
        affine_cast<float>(inverse(affine_cast<double>(instance.world_from_object)));
    instance.mesh = static_cast<int32_t>(scene.meshes.size());
    instance.mirrored = determinant(placing) < 0 ? 1 : 0;
    const Primitive primitive = shape_primitive(scene, record, material);
    scene.meshes.push_back({static_cast<int32_t>(scene.primitives.size()), 1});
    scene.primitives.push_back(primitive);
    scene.instances.push_back(instance);
}

/// Adds particles (x, y, z, radius) in world space.
inline void add_spheres(Scene& scene, const std::vector<float>& spheres, int32_t material) {
    const size_t count = spheres.size() / 4;
    const size_t blocks = (count + sphere_block - 1) / sphere_block;
    Primitive primitive = shape_primitive(scene, {}, material);
    scene.shapes.pop_back();
    primitive.geometry = static_cast<int32_t>(GeometryKind::spheres);
    primitive.first_triangle = static_cast<int32_t>(scene.spheres.size() / 4);
    primitive.triangle_count = static_cast<int32_t>(count);
    const size_t base = scene.spheres.size();
    scene.spheres.resize(base + blocks * sphere_block_floats,
                         std::numeric_limits<float>::quiet_NaN());
    for (size_t i = 0; i < count; ++i) {
        for (size_t c = 0; c < 4; ++c)
            scene.spheres[base + sphere_word(i) + c * sphere_block] = spheres[4 * i + c];
    }
    scene.primitives.push_back(primitive);
    ++scene.world_primitive_count;
    scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
}

/// A scene with one material and nothing in it.
inline Scene empty_scene(const Material& material) {
    SceneBuilder builder;
    builder.material(material);
    return builder.take();
}

}  // namespace obscura::test
