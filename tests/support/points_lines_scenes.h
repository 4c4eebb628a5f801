// tests/support/points_lines_scenes.h - scenes with points and lines in memory, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include "support/shape_scenes.h"
#include <algorithm>
#include <vector>

namespace obscura::test {

/// A vertex of a line or point: position and red.
struct Dot {
    Vec3f position;
    float red = 1;
};

inline void append_red(Scene& scene, const std::vector<Dot>& dots) {
    for (const Dot& dot : dots)
        scene.attributes.insert(scene.attributes.end(), {dot.red, 1, 1, 1});
    scene.attributes.resize(scene.attributes.size() + 4);  // gathers read four words
}

inline void close_primitive(Scene& scene, Primitive primitive, const std::vector<Dot>& dots) {
    primitive.node = static_cast<int32_t>(scene.primitives.size());
    primitive.tangent_base = no_attribute;
    primitive.uv_base[0] = no_attribute;
    scene.primitives.push_back(primitive);
    ++scene.world_primitive_count;
    for (const Dot& dot : dots) {
        const Vec3f& p = dot.position;
        scene.bounds.high = max3(scene.bounds.high, p);
        scene.bounds.low = -max3(-scene.bounds.low, -p);
    }
}

/// Adds a strip of lines in world space; its node is its number among the primitives.
inline void add_strip(Scene& scene,
                      const std::vector<Dot>& dots,
                      float radius,
                      int32_t material = 0) {
    Primitive primitive;
    primitive.geometry = static_cast<int32_t>(GeometryKind::curves);
    primitive.first_triangle = static_cast<int32_t>(scene.curve_segments.size());
    primitive.triangle_count = static_cast<int32_t>(dots.size()) - 1;
    primitive.material = material;
    const size_t first = scene.curve_points.size() / 4;
    primitive.color_base =
        static_cast<int32_t>(scene.attributes.size()) - static_cast<int32_t>(first * 4);
    for (size_t i = 0; i < dots.size(); ++i) {
        const Vec3f& p = dots[i].position;
        scene.curve_points.insert(scene.curve_points.end(), {p.x, p.y, p.z, radius});
        if (i + 1 < dots.size()) scene.curve_segments.push_back(static_cast<uint32_t>(first + i));
    }
    append_red(scene, dots);
    close_primitive(scene, primitive, dots);
}

/// Adds points in world space, in one block or several.
inline void add_points(Scene& scene,
                       const std::vector<Dot>& dots,
                       float radius,
                       int32_t material = 0) {
    std::vector<float> spheres;
    for (const Dot& dot : dots)
        spheres.insert(spheres.end(), {dot.position.x, dot.position.y, dot.position.z, radius});
    add_spheres(scene, spheres, material);
    Primitive primitive = scene.primitives.back();
    scene.primitives.pop_back();
    --scene.world_primitive_count;
    primitive.color_base =
        static_cast<int32_t>(scene.attributes.size()) - primitive.first_triangle * 4;
    append_red(scene, dots);
    close_primitive(scene, primitive, dots);
}

}  // namespace obscura::test
