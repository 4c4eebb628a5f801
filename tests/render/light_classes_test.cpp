// tests/render/light_classes_test.cpp - light of few and of many groups goes to its own.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_path_plan.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "support/thin_wall_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace {

constexpr int lamps_side = 12;

/// A white floor below lamps of one colour each: red, green, blue, red and so on.
Scene colored_lamps(size_t count) {
    ThinWallScene floor;
    for (size_t i = 0; i < count; ++i) {
        PunctualLight lamp = lamp_at({0.2f * static_cast<float>(i % 5) - 0.4f, 1, 0});
        lamp.intensity[(i + 1) % 3] = 0;
        lamp.intensity[(i + 2) % 3] = 0;
        floor.light(lamp);
    }
    Scene scene = floor.take();
    for (size_t i = 0; i < count; ++i)
        scene.info.light_names.push_back("lamp" + std::to_string(i));
    return scene;
}

/// With more groups than max_class_runs, classes are looked up in another way.
TEST(LightClasses, OfManyLampsEachHasItsOwnLight) {
    for (const size_t count : {size_t{3}, size_t{max_class_runs} + 4}) {
        RenderOptions options;
        options.width = lamps_side;
        options.height = lamps_side;
        options.samples_per_pixel = 64;
        options.light_groups = {{}, true, false};
        const Camera down = look_at({0, 2, 0}, {0, 0, 0}, 0.5f, lamps_side, lamps_side);
        const RenderResult result = render_scene(colored_lamps(count), {}, down, options);
        ASSERT_EQ(result.film.layers.size(), count + 2) << "env and rest";
        for (size_t k = 0; k < count; ++k) {
            const FilmLayer& layer = result.film.layers[k];
            double sums[3] = {0, 0, 0};
            for (size_t i = 0; i < layer.pixels.size(); ++i)
                sums[i % 3] += static_cast<double>(layer.pixels[i]);
            EXPECT_GT(sums[k % 3], 0) << layer.layer.name;
            EXPECT_EQ(sums[(k + 1) % 3], 0) << layer.layer.name;
            EXPECT_EQ(sums[(k + 2) % 3], 0) << layer.layer.name;
        }
    }
}

}  // namespace
}  // namespace obscura::test
