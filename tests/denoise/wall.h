// tests/denoise/wall.h - a wall with noisy light on it, to denoise.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/denoise.h"

#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

namespace obscura {

inline constexpr int width = 96;
inline constexpr int height = 80;
inline constexpr size_t pixels = size_t{width} * height;

/// A flat grey wall that faces the camera, 4 m away, and its two half images.
struct Wall {
    std::vector<float> halves[2];
    std::vector<float> albedo = std::vector<float>(3 * pixels, 0.5f);
    std::vector<float> normal = std::vector<float>(3 * pixels, 0.0f);
    std::vector<float> depth = std::vector<float>(pixels, 4.0f);
    std::vector<float> opacity = std::vector<float>(pixels, 1.0f);
    std::vector<float> alpha = std::vector<float>(pixels, 1.0f);

    Wall() {
        for (size_t i = 0; i < pixels; ++i)
            normal[3 * i + 2] = 1;
        for (std::vector<float>& half : halves)
            half.assign(3 * pixels, 0.0f);
    }

    /// Sets both halves to `truth(x, y)` times 1 with exponential noise, the same in all channels.
    void light(const std::function<float(int, int)>& truth, float noise, unsigned seed = 7) {
        std::mt19937 random(seed);
        std::exponential_distribution<float> spread(1);
        for (std::vector<float>& half : halves) {
            for (size_t i = 0; i < pixels; ++i) {
                const float value = truth(static_cast<int>(i % width), static_cast<int>(i / width));
                const float factor = noise > 0 ? 1 + noise * (spread(random) - 1) : 1.0f;
                for (size_t c = 0; c < 3; ++c)
                    half[3 * i + c] = value * factor;
            }
        }
    }

    DenoiseInput input() const {
        DenoiseInput out;
        out.width = width;
        out.height = height;
        out.color = {halves[0], halves[1]};
        out.albedo = {albedo, albedo};
        out.normal = {normal, normal};
        out.depth = depth;
        out.opacity = opacity;
        out.alpha = alpha;
        return out;
    }

    std::vector<float> mean() const {
        std::vector<float> out(3 * pixels);
        for (size_t i = 0; i < out.size(); ++i)
            out[i] = 0.5f * (halves[0][i] + halves[1][i]);
        return out;
    }

    std::vector<float> denoised() const {
        std::vector<float> out = mean();
        denoise(input(), std::vector<LightImage>{{out, 3}});
        return out;
    }
};

inline double total_light(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

inline double mean_square(const std::vector<float>& values,
                          const std::function<float(int, int)>& truth) {
    double total = 0;
    for (size_t i = 0; i < pixels; ++i) {
        const float value = truth(static_cast<int>(i % width), static_cast<int>(i / width));
        total += std::pow(static_cast<double>(values[3 * i] - value), 2);
    }
    return total / pixels;
}

inline float even(int /*x*/, int /*y*/) {
    return 2;
}

}  // namespace obscura
