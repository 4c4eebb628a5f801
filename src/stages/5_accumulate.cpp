// stages/5_accumulate.cpp - stage 5: contributions become samples, samples become pixel sums.
// SPDX-License-Identifier: Apache-2.0
#include "stages/5_accumulate.h"

#include "stages/column_lanes.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

OBSCURA_INLINE uint32_t left_in_block(uint32_t number) {
    return sum_block_samples - number % sum_block_samples;
}

OBSCURA_INLINE void end_block(PixelSum& sum) {
    for (int c = 0; c < 4; ++c) {
        sum.blocks[c] += static_cast<double>(sum.block[c]);
        sum.block[c] = 0;
    }
}

}  // namespace

void add_shadow_light(int count,
                      const ShadowView& columns,
                      const uint8_t* occluded,
                      const SampleColumns& samples) {
    for (int i = 0; i < count; ++i) {
        if (occluded[i] != 0) continue;
        const uint32_t slot = columns.slot[i];
        samples.r[slot] += columns.r[i];
        samples.g[slot] += columns.g[i];
        samples.b[slot] += columns.b[i];
    }
}

uint64_t clear_nonfinite(int count, const SampleColumns& samples) {
    uint64_t nonfinite = 0;
    const Vec3<Lanes> zero = splat3(Lanes(0.0f));
    for (int i = 0; i < count; i += lane_count) {
        const Vec3<Lanes> value = load3(samples.r, samples.g, samples.b, i);
        const Lanes size = abs(value.x) + abs(value.y) + abs(value.z);
        const Mask broken = lanes_in_range(i, count) & !(size <= Lanes(largest_sample));
        if (none(broken)) continue;
        nonfinite += static_cast<uint64_t>(obscura::count(broken));
        store3(samples.r, samples.g, samples.b, i, select(broken, zero, value));
        store(samples.a + i, select(broken, Lanes(0.0f), load(samples.a + i)));
    }
    return nonfinite;
}

uint64_t accumulate(int pixels,
                    const SampleRange& range,
                    const SampleColumns& samples,
                    PixelSum* sums) {
    const uint64_t nonfinite = clear_nonfinite(pixels * range.count, samples);
    int slot = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
        PixelSum& sum = sums[pixel];
        uint32_t number = range.first;
        for (const int end = slot + range.count; slot < end;) {
            if (number % sum_block_samples == 0) end_block(sum);
            const int stop = min(end, slot + static_cast<int>(left_in_block(number)));
            number += static_cast<uint32_t>(stop - slot);
            float r = sum.block[0];
            float g = sum.block[1];
            float b = sum.block[2];
            float a = sum.block[3];
            for (; slot < stop; ++slot) {
                r += samples.r[slot];
                g += samples.g[slot];
                b += samples.b[slot];
                a += samples.a[slot];
            }
            sum.block[0] = r;
            sum.block[1] = g;
            sum.block[2] = b;
            sum.block[3] = a;
        }
    }
    return nonfinite;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
