// stages/5_accumulate.cpp - stage 5: contributions become samples, samples become pixel sums.
// SPDX-License-Identifier: Apache-2.0
#include "stages/5_accumulate.h"

namespace obscura {
inline namespace OBSCURA_ISA {

void add_shadow_light(int count,
                      const ShadowRows& rows,
                      const uint8_t* occluded,
                      const SampleRows& samples) {
    for (int i = 0; i < count; ++i) {
        if (occluded[i] != 0) continue;
        const uint32_t slot = rows.slot[i];
        samples.r[slot] += rows.r[i];
        samples.g[slot] += rows.g[i];
        samples.b[slot] += rows.b[i];
    }
}

/// Above this a sample counts as not finite: the sum of a pixel's samples must stay finite too.
constexpr float largest_sample = 1.0e30f;

uint64_t accumulate(int pixels, int per_pixel, const SampleRows& samples, float* sums) {
    uint64_t nonfinite = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
        float* sum = sums + 4 * pixel;
        for (int i = 0; i < per_pixel; ++i) {
            const int slot = pixel * per_pixel + i;
            const float r = samples.r[slot];
            const float g = samples.g[slot];
            const float b = samples.b[slot];
            const float size = abs(r) + abs(g) + abs(b);
            if (!(size <= largest_sample)) {
                ++nonfinite;
                continue;
            }
            sum[0] += r;
            sum[1] += g;
            sum[2] += b;
            sum[3] += samples.a[slot];
        }
    }
    return nonfinite;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
