// stages/5_accumulate.cpp - stage 5: contributions become samples, samples become pixel sums.
// SPDX-License-Identifier: Apache-2.0
#include "stages/5_accumulate.h"

#include "stages/rows.h"

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

uint64_t clear_nonfinite(int count, const SampleRows& samples) {
    uint64_t nonfinite = 0;
    const Vec3<Lanes> zero = splat3(Lanes(0.0f));
    for (int i = 0; i < count; i += lane_count) {
        const Vec3<Lanes> value = load3(samples.r, samples.g, samples.b, i);
        const Lanes size = abs(value.x) + abs(value.y) + abs(value.z);
        const Mask broken = rows_in_range(i, count) & !(size <= Lanes(largest_sample));
        if (none(broken)) continue;
        nonfinite += static_cast<uint64_t>(obscura::count(broken));
        store3(samples.r, samples.g, samples.b, i, select(broken, zero, value));
        store(samples.a + i, select(broken, Lanes(0.0f), load(samples.a + i)));
    }
    return nonfinite;
}

uint64_t accumulate(int pixels, int per_pixel, const SampleRows& samples, float* sums) {
    const uint64_t nonfinite = clear_nonfinite(pixels * per_pixel, samples);
    int slot = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
        float* sum = sums + size_t{4} * static_cast<size_t>(pixel);
        float r = sum[0];
        float g = sum[1];
        float b = sum[2];
        float a = sum[3];
        for (const int end = slot + per_pixel; slot < end; ++slot) {
            r += samples.r[slot];
            g += samples.g[slot];
            b += samples.b[slot];
            a += samples.a[slot];
        }
        sum[0] = r;
        sum[1] = g;
        sum[2] = b;
        sum[3] = a;
    }
    return nonfinite;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
