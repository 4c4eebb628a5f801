// tests/crosscheck/check_scenes.h - small scenes for cross-checks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/check_scene.h"

#include "support/scene_builder.h"
#include "support/shape_scenes.h"

namespace obscura::test {

/// Two triangles that make the square [-1, 1]^2 at z = 0; its diagonal runs from (-1,-1) to (1,1).
inline Scene square_scene() {
    SceneBuilder builder;
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material({}));
    return builder.take();
}

/// A cube of eight vertices and twelve triangles, outwards, edges of 2 m around the origin.
inline Scene closed_cube() {
    Scene scene;
    scene.materials.emplace_back();
    scene.material_names.emplace_back();
    scene.material_numbers.push_back(-1);
    for (int k = 0; k < 8; ++k) {
        for (int c = 0; c < 3; ++c)
            scene.positions.push_back((k >> c & 1) != 0 ? 1.0F : -1.0F);
    }
    const uint32_t faces[6][4] = {
        {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces)
        scene.indices.insert(scene.indices.end(), {f[0], f[1], f[2], f[0], f[2], f[3]});
    Primitive primitive;
    primitive.triangle_count = 12;
    scene.primitives.push_back(primitive);
    scene.world_primitive_count = 1;
    scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
    pad_tables(scene);
    return scene;
}

inline Camera front_camera() {
    return look_at({0.2F, 0.3F, 5}, {0, 0, 0}, 0.8F, 64, 36);
}

inline crosscheck::RaySetOptions few_rays(uint64_t count) {
    return {front_camera(), 64, 36, count, 0};
}

}  // namespace obscura::test
