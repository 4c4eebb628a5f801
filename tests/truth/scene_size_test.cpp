// tests/truth/scene_size_test.cpp - scenes of any size give the same image.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace scene_size_truth {

/// A smooth ball on a floor under a white sky, everything `size` times as large.
Mean seen(float size) {
    Material grey;
    grey.metallic = 0;
    grey.roughness = 0.5f;
    std::fill_n(grey.base_color, 3, 0.5f);
    SceneBuilder builder;
    const int32_t index = builder.material(grey);
    builder.quad({-size, 0, size}, {2 * size, 0, 0}, {0, 0, -2 * size}, index);
    builder.sphere({0, 0.4f * size, 0}, 0.4f * size, 8, index);
    RenderOptions options;
    options.width = options.height = 32;
    options.samples_per_pixel = 16;
    options.max_bounces = 2;
    LightingOptions lighting;
    lighting.environment = constant_environment(1);
    const Camera camera =
        look_at({0, 3 * size, 2 * size}, {0, 0.2f * size, 0}, 0.4f, options.width, options.height);
    return film_mean(render_scene(builder.take(), lighting, camera, options).film);
}

TEST(SceneSize, ChangesNothing) {
    const double ordinary = seen(1).value;
    EXPECT_GT(ordinary, 0.1);
    for (const float size : {1e-6f, 1e6f, 1e10f, 1e12f})
        EXPECT_NEAR(seen(size).value, ordinary, 2e-3 * ordinary) << size;
}

}  // namespace scene_size_truth
}  // namespace obscura::test
