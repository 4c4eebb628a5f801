// image/exr_pixels.h - an image's values as files hold them: as halves, and at half the size.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/unset_array.h"

#include <OpenEXR/ImfHeader.h>

#include <Imath/half.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// How many of OpenEXR's threads compress so many values: for few starting them does not pay.
int compression_threads(size_t values);

/// The largest value that a part with this header should have as a half: 65504, and less where a
/// codec may come out higher than what went in, which must not become infinite.
float largest_half(const Imf::Header& header);

/// Makes values halves. NaN becomes 0.
///
/// In      halves: as many as values
/// Out     how many had to be clamped to +-largest
uint64_t store_halves(std::span<const float> values, float largest, std::span<half> halves);

/// The same on all threads.
uint64_t store_many_halves(std::span<const float> values, float largest, std::span<half> halves);

/// Interleaved pixels in memory.
struct PixelView {
    const float* pixels;
    int width, height;
    size_t channels;
};

/// The next level of a mipmap: half as wide and high, rounded down, at least 1. A pixel is the mean
/// of 2x2, or the upper left one of them.
UnsetArray<float> half_as_large(const PixelView& image, bool averaged);

}  // namespace obscura
