// image/exr_pixels.cpp - an image's values as files hold them: as halves, and at half the size.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_pixels.h"

#include "base/parallel.h"
#include "image/process_settings.h"

#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace obscura {

int compression_threads(size_t values) {
    constexpr size_t large = 1 << 17;  // below, waking threads takes longer than they save
    constexpr size_t max_threads = 16;
    if (values < large) return 0;
    const int threads = static_cast<int>(std::min(max_thread_index(), max_threads));
    if (owns_process_settings() && Imf::globalThreadCount() < threads) {
        Imf::setGlobalThreadCount(threads);
    }
    return std::min(threads, Imf::globalThreadCount());
}

float largest_half(const Imf::Header& header) {
    constexpr float of_all = 65504;
    const Imf::Compression codec = header.compression();
    if (codec != Imf::DWAA_COMPRESSION && codec != Imf::DWAB_COMPRESSION) return of_all;
    // DWA rounds logarithms, by steps of the level. In blocks of random black and white they come
    // out up to 0.00062 a level too high (measured); twice that, and a thousandth.
    return of_all * std::exp(-0.0013f * header.dwaCompressionLevel() - 0.001f);
}

uint64_t store_halves(std::span<const float> values, float largest, std::span<half> halves) {
    uint64_t clamped = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        const float value = values[i];
        clamped += std::abs(value) > largest ? 1 : 0;
        halves[i] = half(std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest));
    }
    return clamped;
}

uint64_t store_many_halves(std::span<const float> values, float largest, std::span<half> halves) {
    constexpr size_t grain = 1 << 16;
    std::atomic<uint64_t> clamped = 0;
    parallel_ranges(values.size(), grain, [&](size_t begin, size_t end) {
        const size_t count = end - begin;
        clamped +=
            store_halves(values.subspan(begin, count), largest, halves.subspan(begin, count));
    });
    return clamped;
}

UnsetArray<float> half_as_large(const PixelView& image, bool averaged) {
    constexpr size_t grain = 64;
    const size_t channels = image.channels;
    const auto width = static_cast<size_t>(std::max(image.width / 2, 1));
    const auto height = static_cast<size_t>(std::max(image.height / 2, 1));
    const size_t row = static_cast<size_t>(image.width) * channels;
    // One pixel wide or high, the second of a pair is the first once more.
    const size_t right = image.width > 1 ? channels : 0;
    const size_t below = image.height > 1 ? row : 0;
    UnsetArray<float> out(width * height * channels);
    parallel_ranges(height, grain, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) {
            float* to = out.data() + y * width * channels;
            for (size_t x = 0; x < width; ++x) {
                const float* from = image.pixels + 2 * y * row + 2 * x * channels;
                for (size_t c = 0; c < channels; ++c, ++from, ++to) {
                    *to = averaged ? 0.25f * ((from[0] + from[right]) +
                                              (from[below] + from[below + right]))
                                   : from[0];
                }
            }
        }
    });
    return out;
}

}  // namespace obscura
