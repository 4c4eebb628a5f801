// film/catcher_sums.cpp - the light that the shadow catchers of a pixel received, and its alpha.
// SPDX-License-Identifier: Apache-2.0
#include "film/catcher_sums.h"

#include <algorithm>

namespace obscura {

CatcherLight& CatcherLight::operator+=(const CatcherLight& other) {
    shadowed += other.shadowed;
    unshadowed += other.unshadowed;
    for (size_t c = 0; c < background.size(); ++c)
        background[c] += other.background[c];
    transmitted += other.transmitted;
    return *this;
}

void add_catcher_samples(const std::vector<CatcherSample>& samples,
                         const SampleRange& range,
                         std::span<CatcherSum> sums) {
    const auto per_pixel = static_cast<uint32_t>(range.count);
    for (const CatcherSample& sample : samples) {
        CatcherSum& pixel = sums[sample.slot / per_pixel];
        CatcherLight& sum = pixel.block_of(range.first + sample.slot % per_pixel);
        sum.shadowed += static_cast<double>(sample.shadowed);
        sum.unshadowed += static_cast<double>(sample.unshadowed);
        for (size_t c = 0; c < 4; ++c)
            sum.background[c] += static_cast<double>(sample.background[c]);
        sum.transmitted += static_cast<double>(sample.transmitted);
    }
}

double shadow_alpha(const CatcherLight& sum) {
    if (!(sum.unshadowed > 0)) return 0;
    return std::clamp(1 - sum.shadowed / sum.unshadowed, 0.0, 1.0);
}

std::array<float, 4> catcher_part(const CatcherLight& sum, int samples) {
    const double alpha = shadow_alpha(sum);
    std::array<float, 4> out = {0, 0, 0, 0};
    for (size_t c = 0; c < 4; ++c) {
        const double shadow = c == 3 ? alpha * sum.transmitted : 0;
        out[c] = static_cast<float>((shadow + (1 - alpha) * sum.background[c]) / samples);
    }
    return out;
}

}  // namespace obscura
