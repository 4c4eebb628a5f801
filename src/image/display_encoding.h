// image/display_encoding.h - how an image becomes the code values of a file for a display.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/display.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace obscura {

struct OutputImage;

/// How an image becomes a file for a display: of every format but EXR.
struct DisplayEncoding {
    const DisplayTransform* transform = nullptr;  ///< null: values in [0, 1] are encoded already
    int bits = 8;                                 ///< of a channel: 8 or 16
    std::optional<int> quality = {};              ///< 1 to 100; none: the format's own
    bool dither = true;  ///< 8-bit colours that went through `transform`, not data or alpha
    /// A colour behind the finished image, in the display's encoded values from 0 to 1. The file
    /// then has no alpha.
    std::optional<std::array<float, 3>> page = {};
};

/// The threshold in (0, 1) at which a fraction of a code rounds up at a pixel of the whole image:
/// an additive recurrence, which spreads like blue noise. Any square of 10 x 10 pixels or more
/// shows a constant value right to 0.05 codes. The thresholds keep 1/512 from 0 and 1, so that
/// whole codes stay what they are.
///
/// Source  M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018: R2
constexpr float dither_threshold(size_t x, size_t y) noexcept {
    // 2^32 / g and 2^32 / g^2, where g^3 = g + 1.
    const uint32_t phase =
        static_cast<uint32_t>(x) * 3242174889U + static_cast<uint32_t>(y) * 2447445414U;
    return (static_cast<float>(phase >> 24) + 0.5f) / 256;
}

/// The interleaved code values of a whole image: grey, RGB, or RGB and straight alpha.
///
/// Colour is divided by alpha, goes through the transform and lies over the page by its alpha, in
/// encoded values as browsers blend: an edge shows its own colour and the page's, nothing else.
///
/// In      keep_alpha: false: the file has none; without a page the image then lies over black
/// Out     Code is uint8_t, or uint16_t, which is never dithered
template <typename Code>
std::vector<Code> display_codes(const OutputImage& image,
                                bool keep_alpha,
                                const DisplayEncoding& encoding);

}  // namespace obscura
