// film/noise.cpp - how noisy the pixels of an unfinished image are, by what more samples changed.
// SPDX-License-Identifier: Apache-2.0
#include "film/noise.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

constexpr size_t noise_colors = 3;
constexpr int window_reach = noise_window / 2;

/// A pixel's mean and squared difference between its parts, the latter as variance of one sample.
struct PixelNoise {
    std::array<float, noise_colors> mean = {};
    std::array<float, noise_colors> variance = {};
};

PixelNoise noise_of(const SampledImage& image, size_t pixel) {
    const double n = image.samples[pixel];
    const double before = image.samples_before[pixel];
    // The difference of the mean of n samples and that of the first m of them has the variance of a
    // sample times 1/m - 1/n.
    const double scale = n * before / (n - before);
    PixelNoise out;
    for (size_t c = 0; c < std::min(image.channels, noise_colors); ++c) {
        out.mean[c] = image.pixels[pixel * image.channels + c];
        const double change = static_cast<double>(out.mean[c]) -
                              static_cast<double>(image.before[pixel * image.channels + c]);
        out.variance[c] = static_cast<float>(change * change * scale);
    }
    return out;
}

/// The window's rows and columns that lie in the image.
struct WindowRange {
    int begin, end;
};

WindowRange around(int center, int size) {
    return {std::max(center - window_reach, 0), std::min(center + window_reach + 1, size)};
}

/// The relative deviation of a pixel by its neighbours.
float deviation(std::span<const PixelNoise> noise, const SampledImage& image, int x, int y) {
    const WindowRange rows = around(y, image.height);
    const WindowRange columns = around(x, image.width);
    const int count = (rows.end - rows.begin) * (columns.end - columns.begin);
    std::array<double, noise_colors> mean = {};
    std::array<double, noise_colors> variance = {};
    for (int row = rows.begin; row < rows.end; ++row) {
        for (int column = columns.begin; column < columns.end; ++column) {
            const auto at = static_cast<size_t>(row) * static_cast<size_t>(image.width) +
                            static_cast<size_t>(column);
            const bool own = row == y && column == x && count > 1;
            for (size_t c = 0; c < noise_colors; ++c) {
                mean[c] += static_cast<double>(noise[at].mean[c]);
                if (!own) variance[c] += static_cast<double>(noise[at].variance[c]);
            }
        }
    }
    const double darkest = darkest_error_white * image.white;
    double sum = 0;
    for (size_t c = 0; c < noise_colors; ++c) {
        const double color = mean[c] / count;
        sum += variance[c] / std::max(count - 1, 1) / (color * color + darkest * darkest);
    }
    return static_cast<float>(std::sqrt(sum / noise_colors));
}

}  // namespace

std::vector<float> sample_deviations(const SampledImage& image) {
    std::vector<PixelNoise> noise(image.samples.size());
    constexpr size_t grain = 4096;
    parallel_ranges(noise.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            noise[i] = noise_of(image, i);
    });
    std::vector<float> out(noise.size());
    parallel_for(static_cast<size_t>(image.height), [&](size_t y) {
        for (int x = 0; x < image.width; ++x) {
            out[y * static_cast<size_t>(image.width) + static_cast<size_t>(x)] =
                deviation(noise, image, x, static_cast<int>(y));
        }
    });
    return out;
}

double image_noise(std::span<const float> deviations, std::span<const int> samples) {
    double sum = 0;
    for (size_t i = 0; i < deviations.size(); ++i) {
        const auto deviation = static_cast<double>(deviations[i]);
        sum += deviation * deviation / samples[i];
    }
    return std::sqrt(sum / static_cast<double>(std::max<size_t>(deviations.size(), 1)));
}

}  // namespace obscura
