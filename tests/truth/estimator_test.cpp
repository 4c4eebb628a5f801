// tests/truth/estimator_test.cpp - properties of the estimator: strategies agree, bits repeat.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "truth/reference.h"
#include <cstring>

namespace obscura::test {
namespace estimator_truth {

/// A floor, a glossy and a rough sphere, an emissive quad and a veil, under a sky with a bright
/// spot.
Scene mixed_scene() {
    SceneBuilder builder;
    Material ground;
    ground.metallic = 0;
    ground.base_color[0] = 0.5f;
    Material gloss;
    gloss.roughness = 0.35f;
    Material rough;
    rough.metallic = 0;
    rough.roughness = 0.6f;
    rough.base_color[1] = 0.3f;
    Material lamp;
    std::fill_n(lamp.emission, 3, 6.0f);
    Material veil;
    veil.metallic = 0;
    veil.base_color[3] = 0.4f;
    veil.flags = material_alpha_blend | material_double_sided;
    builder.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, builder.material(ground));
    builder.sphere({-0.8f, 0.7f, 0}, 0.7f, 24, builder.material(gloss));
    builder.sphere({0.8f, 0.7f, 0}, 0.7f, 24, builder.material(rough));
    builder.quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}, builder.material(lamp));
    builder.quad({-1, 0.2f, 1.2f}, {2, 0, 0}, {0, 0.8f, 0}, builder.material(veil));
    return builder.take();
}

LightingOptions mixed_light() {
    ImageRgb32f sky{64, 32, {}};
    sky.pixels.assign(64 * 32 * 3, 0.3f);
    for (int y = 6; y < 10; ++y) {
        for (int x = 20; x < 26; ++x)
            sky.pixels[static_cast<size_t>(y * 64 + x) * 3] = 15.0f;
    }
    LightingOptions lighting;
    lighting.environment = shared(sky);
    return lighting;
}

Camera mixed_camera(int width, int height) {
    return look_at({0, 1.5f, 4}, {0, 0.6f, 0}, 0.7f, width, height);
}

TEST(Strategies, LightSamplingBsdfSamplingAndBothAgree) {
    RenderOptions options;
    options.width = options.height = 24;
#ifdef OBSCURA_DEBUG
    options.samples_per_pixel = 64;
#else
    options.samples_per_pixel = 1024;
#endif
    options.max_bounces = 3;
    // Independent runs give the standard error of the image's mean.
    const auto measure = [&](int strategies) {
        options.strategies = strategies;
        constexpr int runs = 24;
        double sum = 0;
        double squares = 0;
        for (int run = 0; run < runs; ++run) {
            options.seed = static_cast<uint64_t>(100 * strategies + run);
            const double v =
                film_mean(
                    render_scene(mixed_scene(), mixed_light(), mixed_camera(24, 24), options).film)
                    .value;
            sum += v;
            squares += v * v;
        }
        const double mean = sum / runs;
        return Mean{mean, std::sqrt(std::max(0.0, squares / runs - mean * mean) / (runs - 1))};
    };
    const Mean both = measure(3);
    for (const int strategies : {1, 2}) {
        const Mean one = measure(strategies);
        const double sigma = std::sqrt(both.error * both.error + one.error * one.error);
        EXPECT_NEAR(one.value, both.value, 3.0 * sigma) << "strategy " << strategies;
        EXPECT_LT(sigma, 0.05 * both.value) << "too noisy to tell anything";
    }
}

UnsetArray<float> pixels_with(int threads, int tile_size, std::optional<PixelRect> crop) {
    const ThreadLimit limit(threads);
    RenderOptions options;
    options.width = 70;
    options.height = 50;
    options.samples_per_pixel = 20;
    options.tile_size = tile_size;
    options.crop = crop;
    options.filter = PixelFilter::gaussian;
    return render_scene(mixed_scene(), mixed_light(), mixed_camera(70, 50), options).film.pixels;
}

TEST(Determinism, ThreadsAndTilesDoNotChangeABit) {
    const UnsetArray<float> reference = pixels_with(1, 16, {});
    for (const int threads : {1, 2, 7}) {
        for (const int tile_size : {8, 16, 32, 64}) {
            const UnsetArray<float> other = pixels_with(threads, tile_size, {});
            ASSERT_EQ(other.size(), reference.size());
            EXPECT_EQ(std::memcmp(other.data(), reference.data(), other.size() * sizeof(float)), 0)
                << threads << " threads, tiles of " << tile_size;
        }
    }
}

TEST(Determinism, ACropIsAPieceOfTheWhole) {
    const UnsetArray<float> whole = pixels_with(2, 16, {});
    const PixelRect crop{13, 7, 31, 29};
    const UnsetArray<float> piece = pixels_with(2, 16, crop);
    ASSERT_EQ(piece.size(), size_t{31 * 29 * 4}) << "no pixel but those of the crop is held";
    for (int y = 0; y < crop.height; ++y) {
        for (int x = 0; x < crop.width; ++x) {
            for (int c = 0; c < 4; ++c) {
                const auto i = static_cast<size_t>((y * crop.width + x) * 4 + c);
                const auto j = static_cast<size_t>(((y + crop.y) * 70 + x + crop.x) * 4 + c);
                EXPECT_EQ(piece[i], whole[j]) << x << "," << y;
            }
        }
    }
}

TEST(Determinism, TheSeedMatters) {
    RenderOptions options;
    options.width = options.height = 16;
    options.samples_per_pixel = 4;
    const auto with_seed = [&](uint64_t seed) {
        options.seed = seed;
        return render_scene(mixed_scene(), mixed_light(), mixed_camera(16, 16), options)
            .film.pixels;
    };
    EXPECT_EQ(with_seed(5), with_seed(5));
    EXPECT_NE(with_seed(5), with_seed(6));
    EXPECT_NE(with_seed(5), with_seed(5ULL + (1ULL << 32)));
}

TEST(InstructionSets, AgreeWithBaselineToRounding) {
    RenderOptions options;
    options.width = options.height = 48;
    options.samples_per_pixel = 16;
    if (!has_isa(Isa::baseline)) GTEST_SKIP() << "this build has one set alone (OBSCURA_ISAS)";
    const auto with_isa = [&](Isa isa) {
        return render_scene(mixed_scene(), mixed_light(), mixed_camera(48, 48), options, isa).film;
    };
    const Film baseline = with_isa(Isa::baseline);
    for (const Isa isa : {Isa::avx2, Isa::avx512}) {
        if (!has_isa(isa)) {
            std::puts("[  SKIPPED ] one instruction set: this CPU does not have it");
            continue;
        }
        const Film other = with_isa(isa);
        // The same random numbers: pixels differ where rounding sends a path elsewhere.
        int different = 0;
        double sum = 0;
        double sum_baseline = 0;
        for (size_t i = 0; i < baseline.pixels.size(); ++i) {
            const float a = baseline.pixels[i];
            const float b = other.pixels[i];
            different += std::fabs(a - b) > 1e-3f * (1.0f + std::fabs(a)) ? 1 : 0;
            sum += static_cast<double>(b);
            sum_baseline += static_cast<double>(a);
        }
        EXPECT_LT(different, static_cast<int>(baseline.pixels.size() / 50));
        EXPECT_NEAR(sum, sum_baseline, 2e-3 * sum_baseline);
    }
}

}  // namespace estimator_truth
}  // namespace obscura::test
