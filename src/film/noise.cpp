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
constexpr size_t alpha_channel = 3;

/// Sums over pixels of their means and of the squared differences between their parts, the latter
/// as variances of one sample.
struct NoiseSum {
    std::array<double, noise_colors> mean = {};
    std::array<double, noise_colors> variance = {};
};

/// Those of an image as it is seen over black, and over white: where alpha is noisy, colours may be
/// smooth over one of them.
struct NoiseSums {
    int count = 0;
    NoiseSum over_black, over_white;
};

/// What the squared difference of the two parts of a group's pixels is multiplied with: that of the
/// mean of n samples and of the first m of them has the variance of a sample times 1/m - 1/n.
std::vector<double> variance_scales(const SampledImage& image, const PixelGroups& groups) {
    std::vector<double> out(groups.count(), 0.0);
    for (size_t i = 0; i < out.size(); ++i) {
        const double n = image.samples[i];
        const double m = image.samples_before[i];
        if (n > m) out[i] = n * m / (n - m);
    }
    return out;
}

/// Adds a pixel to the sums of its colour.
void add_pixel(const SampledImage& image, size_t pixel, double scale, NoiseSums& sums) {
    const float* const after = image.pixels.data() + pixel * image.channels;
    const float* const before = image.before.data() + pixel * image.channels;
    double behind = 0, change_behind = 0;  // what white adds
    if (image.channels > alpha_channel) {
        const auto alpha = static_cast<double>(after[alpha_channel]);
        behind = image.white * (1 - alpha);
        change_behind = image.white * (static_cast<double>(before[alpha_channel]) - alpha);
    }
    ++sums.count;
    for (size_t c = 0; c < noise_colors; ++c) {
        const size_t channel = std::min(c, image.channels - 1);  // one is grey
        const auto mean = static_cast<double>(after[channel]);
        const double change = mean - static_cast<double>(before[channel]);
        const double change_over_white = change + change_behind;
        sums.over_black.mean[c] += mean;
        sums.over_black.variance[c] += change * change * scale;
        sums.over_white.mean[c] += mean + behind;
        sums.over_white.variance[c] += change_over_white * change_over_white * scale;
    }
}

double relative_variance(const NoiseSum& sum, int count, double darkest) {
    double out = 0;
    for (size_t c = 0; c < noise_colors; ++c) {
        const double color = sum.mean[c] / count;
        out += sum.variance[c] / count / (color * color + darkest * darkest);
    }
    return out;
}

/// The relative deviation that sums stand for.
float deviation_of(const NoiseSums& sums, double white) {
    if (sums.count == 0) return 0;
    const double darkest = darkest_error_white * white;
    const double out = std::max(relative_variance(sums.over_black, sums.count, darkest),
                                relative_variance(sums.over_white, sums.count, darkest));
    return static_cast<float>(std::sqrt(out / noise_colors));
}

/// The deviations of the two groups of a block.
std::array<float, 2> block_deviations(const SampledImage& image,
                                      const PixelGroups& groups,
                                      std::span<const double> scales,
                                      size_t column,
                                      size_t row) {
    constexpr int side = PixelGroups::block_side;
    const int x = static_cast<int>(column) * side;
    const int y = static_cast<int>(row) * side;
    std::array<NoiseSums, 2> sums;
    for (int v = std::max(y - noise_margin, 0); v < std::min(y + side + noise_margin, image.height);
         ++v) {
        for (int u = std::max(x - noise_margin, 0);
             u < std::min(x + side + noise_margin, image.width);
             ++u) {
            const auto color = static_cast<size_t>(u + v) % 2;
            const auto pixel =
                static_cast<size_t>(v) * static_cast<size_t>(image.width) + static_cast<size_t>(u);
            add_pixel(image, pixel, scales[groups.of(u, v)], sums[color]);
        }
    }
    // A pixel without neighbours is judged by itself.
    if (sums[1].count == 0) sums[1] = sums[0];
    return {deviation_of(sums[1], image.white), deviation_of(sums[0], image.white)};
}

}  // namespace

std::vector<int> PixelGroups::sizes() const {
    std::vector<int> out(count(), 0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            ++out[of(x, y)];
    }
    return out;
}

std::vector<float> sample_deviations(const SampledImage& image) {
    const PixelGroups groups{image.width, image.height};
    const size_t across = PixelGroups::blocks_in(image.width);
    const std::vector<double> scales = variance_scales(image, groups);
    std::vector<float> out(groups.count());
    parallel_for(PixelGroups::blocks_in(image.height), [&](size_t row) {
        for (size_t column = 0; column < across; ++column) {
            const std::array<float, 2> deviations =
                block_deviations(image, groups, scales, column, row);
            std::copy_n(deviations.data(), 2, out.data() + 2 * (row * across + column));
        }
    });
    return out;
}

double image_noise(std::span<const float> deviations,
                   std::span<const int> samples,
                   const PixelGroups& groups) {
    const std::vector<int> sizes = groups.sizes();
    double sum = 0;
    double pixels = 0;
    for (size_t i = 0; i < sizes.size(); ++i) {
        if (sizes[i] == 0) continue;
        const auto deviation = static_cast<double>(deviations[i]);
        sum += sizes[i] * deviation * deviation / samples[i];
        pixels += sizes[i];
    }
    return std::sqrt(sum / std::max(pixels, 1.0));
}

}  // namespace obscura
