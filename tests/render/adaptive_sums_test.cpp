// tests/render/adaptive_sums_test.cpp - adaptive sampling: same bits, no bias, goal reached.
// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_sums.h"

#include "base/parallel.h"
#include "image/channel_planes.h"
#include "render/integrators.h"
#include "render/sample_plan.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include <numeric>

namespace obscura::test {
namespace {

/// A ball on a floor below a small lamp and a faint sky; the camera sees some of that.
Scene ball_scene() {
    SceneBuilder builder;
    Material lamp;
    std::fill_n(lamp.emission, 3, 20.0f);
    const int32_t grey = builder.material({});
    builder.quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, grey);
    builder.sphere({0, 0.7f, 0}, 0.7f, 12, grey);
    builder.quad({-1.5f, 2.5f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, builder.material(lamp));
    return builder.take();
}

RenderOptions ball_options() {
    RenderOptions options;
    options.width = 57;
    options.height = 43;
    options.max_bounces = 3;
    options.samples_per_pixel = 128;
    options.adaptive = AdaptiveOptions{.noise_target = 0.03, .min_samples = 8};
    return options;
}

RenderResult render_ball(const RenderOptions& options) {
    LightingOptions light;
    light.environment = constant_environment(0.2f);
    const Camera camera = look_at({0, 1.5f, 5}, {0, 0.9f, 0}, 0.8f, options.width, options.height);
    return render_scene(ball_scene(), light, camera, options);
}

std::vector<Layer> layers(const std::vector<std::string>& names) {
    return layers_of(names, 2).value();
}

const FilmLayer& layer(const RenderResult& result, std::string_view name) {
    for (const FilmLayer& one : result.film.layers) {
        if (one.layer.name == name) return one;
    }
    throw std::runtime_error("no layer " + std::string(name));
}

/// Where a channel of a pixel lies in a layer's memory.
size_t index_of(const FilmLayer& layer, size_t pixel, size_t channel) {
    const size_t channels = layer.layer.channels.size();
    size_t found = 0;
    for_planes(channels, layer.pixels.size() / channels, [&](const ChannelPlane& plane) {
        if (channel < plane.first_channel) return;
        found = plane.first_value + pixel * plane.channels + channel - plane.first_channel;
    });
    return found;
}

double mean_color(const Film& film) {
    double sum = 0;
    for (size_t i = 0; i < film.pixels.size(); i += 4) {
        for (size_t c = 0; c < 3; ++c)
            sum += static_cast<double>(film.pixels[i + c]);
    }
    return sum / static_cast<double>(film.pixels.size());
}

TEST(Passes, EveryPixelIsThatOfAUniformRenderingWithItsSamples) {
    RenderOptions options = ball_options();
    options.layers = layers({"sample_count",
                             "variance",
                             "normal",
                             "depth",
                             "crypto_object",
                             "diffuse_direct",
                             "shadow",
                             "cost"});
    options.catcher_ground_m = -0.5f;
    options.samples_per_pixel = 4 * min_samples_to_go_on;
    options.adaptive = AdaptiveOptions{.noise_target = 0.01, .min_samples = min_samples_to_go_on};
    const RenderResult adaptive = render_ball(options);
    const FilmLayer& counts = layer(adaptive, "sample_count");
    const int least = adaptive.adaptive->least;
    const int most = adaptive.adaptive->most;
    EXPECT_EQ(least, min_samples_to_go_on);
    EXPECT_GT(most, least) << "the test is to see several numbers";
    options.adaptive.reset();
    uint64_t compared = 0;
    for (const int samples : sample_levels(least, 4 * least)) {
        options.samples_per_pixel = samples;
        const RenderResult uniform = render_ball(options);
        for (size_t i = 0; i < counts.pixels.size(); ++i) {
            if (counts.pixels[i] != static_cast<float>(samples)) continue;
            ++compared;
            for (size_t c = 0; c < 4; ++c)
                ASSERT_EQ(adaptive.film.pixels[4 * i + c], uniform.film.pixels[4 * i + c]);
            for (size_t k = 0; k < adaptive.film.layers.size(); ++k) {
                const FilmLayer& own = adaptive.film.layers[k];
                const size_t channels = own.layer.channels.size();
                for (size_t c = 0; c < channels; ++c) {
                    const size_t at = index_of(own, i, c);
                    ASSERT_EQ(own.pixels[at], uniform.film.layers[k].pixels[at]) << own.layer.name;
                }
            }
        }
    }
    EXPECT_EQ(compared, counts.pixels.size());
    const double total = std::accumulate(counts.pixels.begin(), counts.pixels.end(), 0.0);
    EXPECT_EQ(static_cast<double>(adaptive.adaptive->total), total);
    EXPECT_EQ(adaptive.counters.paths, adaptive.adaptive->total);
    EXPECT_EQ(adaptive.adaptive->pixels, counts.pixels.size());
}

TEST(Passes, ThreadsAndTilesDoNotChangeABit) {
    RenderOptions options = ball_options();
    options.layers = layers({"sample_count", "normal", "crypto_object"});
    const auto rendered = [&](int threads, int tile_size) {
        const ThreadLimit limit(threads);
        options.tile_size = tile_size;
        return render_ball(options);
    };
    const auto expect_equal = [](const UnsetArray<float>& a, const UnsetArray<float>& b) {
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    };
    const RenderResult alone = rendered(1, 16);
    for (const int tile_size : {7, 64}) {
        const RenderResult other = rendered(4, tile_size);
        expect_equal(alone.film.pixels, other.film.pixels);
        for (size_t k = 0; k < options.layers.size(); ++k)
            expect_equal(alone.film.layers[k].pixels, other.film.layers[k].pixels);
    }
}

TEST(Passes, LayersDoNotChangeWhichPixelsGoOn) {
    RenderOptions options = ball_options();
    options.layers = layers({"sample_count"});
    const RenderResult alone = render_ball(options);
    options.layers = layers({"sample_count", "shadow", "cost", "normal", "specular_indirect"});
    const RenderResult others = render_ball(options);
    const auto& a = layer(alone, "sample_count").pixels;
    const auto& b = layer(others, "sample_count").pixels;
    EXPECT_GT(*std::max_element(a.begin(), a.end()), *std::min_element(a.begin(), a.end()));
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

TEST(Passes, ReachTheNoiseThatIsAskedFor) {
    RenderOptions options = ball_options();
    options.samples_per_pixel = 4096;
    options.adaptive->noise_target = 0.04;
    const RenderResult result = render_ball(options);
    EXPECT_LT(result.adaptive->noise.value(), 1.15 * 0.04);
    RenderOptions exact = options;
    exact.adaptive.reset();
    exact.samples_per_pixel = 2048;
    exact.seed = 7;
    const RenderResult reference = render_ball(exact);
    double sum = 0;
    for (size_t i = 0; i < reference.film.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        const auto r = static_cast<double>(reference.film.pixels[i]);
        const double d = static_cast<double>(result.film.pixels[i]) - r;
        sum += d * d / (r * r + 0.01);
    }
    const double error = std::sqrt(sum / static_cast<double>(reference.film.pixels.size()) * 4 / 3);
    EXPECT_LT(error, 1.2 * result.adaptive->noise.value())
        << "the estimate may be on the safe side";
    EXPECT_GT(error, 0.3 * result.adaptive->noise.value());
}

TEST(Passes, TheMeanOfTheImageHasNoBias) {
    RenderOptions exact = ball_options();
    exact.adaptive.reset();
    exact.samples_per_pixel = 4096;
    exact.seed = 1000;
    const double reference = mean_color(render_ball(exact).film);
    RenderOptions options = ball_options();
    double sum = 0;
    constexpr int seeds = 24;
    for (int seed = 0; seed < seeds; ++seed) {
        options.seed = static_cast<uint64_t>(seed);
        sum += mean_color(render_ball(options).film);
    }
    EXPECT_NEAR(sum / seeds / reference, 1, 1e-3);
}

TEST(Passes, CleanImagesStopAtTheLeast) {
    RenderOptions options = ball_options();
    SceneBuilder builder;
    builder.quad({90, 90, 90}, {1, 0, 0}, {0, 1, 0}, builder.material({}));
    LightingOptions light;
    light.environment = constant_environment(0.5f);
    const Camera camera = look_at({0, 0, 0}, {0, 0, -1}, 0.8f, options.width, options.height);
    const RenderResult result = render_scene(builder.take(), light, camera, options);
    EXPECT_EQ(result.adaptive->passes, 1);
    EXPECT_EQ(result.adaptive->least, 8);
    EXPECT_EQ(result.adaptive->most, 8);
    EXPECT_EQ(result.adaptive->noise.value(), 0);
    EXPECT_EQ(result.film.pixels[0], 0.5f);
}

TEST(Passes, ProgressGrowsToTheWholeAndStopsOnRequest) {
    RenderOptions options = ball_options();
    Log log(Verbosity::quiet);
    LightingOptions light;
    light.environment = constant_environment(0.2f);
    auto prepared = PreparedScene::create(ball_scene(), light, Isa::automatic, log);
    ASSERT_TRUE(prepared);
    const Camera camera = look_at({0, 1.5f, 5}, {0, 0.9f, 0}, 0.8f, options.width, options.height);
    std::atomic<bool> stop = false;
    const ThreadLimit one(1);  // so that shares come in order
    double last = 0;
    const auto finished = render(
        *prepared,
        camera,
        options,
        [&](const FinishedTile& tile) {
            EXPECT_GE(tile.done, last);
            last = tile.done;
        },
        stop);
    ASSERT_TRUE(finished);
    EXPECT_EQ(last, 1.0);
    const auto stopped = render(
        *prepared,
        camera,
        options,
        [&](const FinishedTile& tile) {
            if (tile.done > 0.5) stop = true;
        },
        stop);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().id, "E-STOPPED");
}

}  // namespace
}  // namespace obscura::test
