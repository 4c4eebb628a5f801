// denoise/outliers.cpp - finds pixels whose light one rare path has brought.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/outliers.h"

#include <cstdint>
#include <numeric>

namespace obscura {

namespace {

/// Pixels on every side that a value is compared with, in both halves.
constexpr int radius = 2;
/// So many values around may be as bright as an outlier without vouching for it.
constexpr size_t rank = 4;

Plane brightness(const Rgb& from) {
    const Plane& size = from[0];
    return make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
        return (from[0].row(y)[x] + from[1].row(y)[x] + from[2].row(y)[x]) * (1.0f / 3.0f);
    });
}

/// For a row of pixels the `rank`-brightest value around each, without its own.
void rank_row(const Plane* halves, int y, std::array<std::vector<float>, rank>& brightest) {
    const int width = halves[0].width();
    const int height = halves[0].height();
    for (std::vector<float>& values : brightest)
        values.assign(static_cast<size_t>(width), 0.0f);
    for (int step = 0; step < 2 * (2 * radius + 1) * (2 * radius + 1); ++step) {
        const int dx = step / 2 % (2 * radius + 1) - radius;
        const int dy = step / 2 / (2 * radius + 1) - radius;
        // Beyond its edges the image repeats itself: no pixel may vouch for itself there.
        if ((dx == 0 && dy == 0) || y + dy < 0 || y + dy >= height) continue;
        const float* const in = halves[step % 2].row(y + dy) + dx;
        float* const top[rank] = {
            brightest[0].data(), brightest[1].data(), brightest[2].data(), brightest[3].data()};
        for (int x = std::max(0, -dx); x < std::min(width, width - dx); ++x) {
            float value = in[x];
            for (float* const sorted : top) {
                const float larger = std::max(sorted[x], value);
                value = std::min(sorted[x], value);
                sorted[x] = larger;
            }
        }
    }
}

}  // namespace

Outliers find_outliers(const Rgb& first, const Rgb& second) {
    constexpr float above_other_half = 2.0f;
    const Plane halves[2] = {brightness(first), brightness(second)};
    const int width = halves[0].width();
    const int height = halves[0].height();
    const int border = halves[0].border();
    Outliers out{{Plane(width, height, border), Plane(width, height, border)}};
    std::vector<int64_t> counts(static_cast<size_t>(height));
    parallel_ranges(counts.size(), rows_per_task, [&](size_t begin, size_t end) {
        std::array<std::vector<float>, rank> brightest;
        for (size_t at = begin; at < end; ++at) {
            const int y = static_cast<int>(at);
            rank_row(halves, y, brightest);
            for (int x = 0; x < width; ++x) {
                const float around = brightest[rank - 1][static_cast<size_t>(x)];
                bool any = false;
                for (size_t half = 0; half < 2; ++half) {
                    const float value = halves[half].row(y)[x];
                    const float other = above_other_half * halves[1 - half].row(y)[x];
                    const float most = std::max(around, other);
                    const bool outlier = value > most;
                    out.keep[half].row(y)[x] = outlier ? most / value : 1.0f;
                    any |= outlier;
                }
                counts[at] += any ? 1 : 0;
            }
        }
    });
    const auto pixels = static_cast<double>(width) * height;
    out.share =
        static_cast<double>(std::accumulate(counts.begin(), counts.end(), int64_t{0})) / pixels;
    return out;
}

}  // namespace obscura
