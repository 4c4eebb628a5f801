// tests/render/integrators_test.cpp - every integrator delivers the channels that its entry names.
// SPDX-License-Identifier: Apache-2.0
#include "render/integrators.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace obscura::test {
namespace {

TEST(Integrators, FilmsHaveTheirChannels) {
    for (const IntegratorEntry& entry : integrator_entries) {
        SceneBuilder builder;
        builder.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, builder.material({}));
        RenderOptions options;
        options.width = 20;
        options.height = 12;
        options.samples_per_pixel = 2;
        options.integrator = entry.value;
        const Camera camera = look_at({0, 0, 3}, {0, 0, 0}, 0.5f, 20, 12);
        const RenderResult result = render_scene(builder.take(), {}, camera, options);
        EXPECT_EQ(result.film.channels, film_channels(entry.value)) << entry.name;
        EXPECT_EQ(result.film.pixels.size(), 20 * 12 * result.film.channels.size()) << entry.name;
        EXPECT_EQ(result.counters.paths, 20U * 12U * static_cast<unsigned>(samples_taken(options)))
            << entry.name;
        const bool has_uv = entry.value == Integrator::uv;  // this quad has none
        for (const float value : result.film.pixels) {
            ASSERT_TRUE(std::isfinite(value)) << entry.name;
            ASSERT_TRUE(!has_uv || value == 0);
        }
    }
}

TEST(Integrators, SamplesAreAskedForWhereTheyMatter) {
    RenderOptions options;
    options.samples_per_pixel = 64;
    const auto samples = [&](Integrator integrator) {
        options.integrator = integrator;
        return samples_taken(options);
    };
    EXPECT_EQ(samples(Integrator::path), 64);
    EXPECT_EQ(samples(Integrator::ao), 64);
    EXPECT_EQ(samples(Integrator::raycast), 1);
    EXPECT_EQ(samples(Integrator::depth), 1);
    EXPECT_EQ(samples(Integrator::wireframe), wireframe_rays);
}

}  // namespace
}  // namespace obscura::test
