// image/display_encoding.cpp - finished images as code values: display, page, dither, rounding.
// SPDX-License-Identifier: Apache-2.0
#include "image/display_encoding.h"

#include "base/parallel.h"
#include "image/write.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obscura {

namespace {

float in_unit_range(float value) {
    return std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f);
}

/// The code of a value; with a threshold of one half it is the nearest.
template <typename Code>
Code code_of(float value, float threshold) {
    constexpr float highest = std::numeric_limits<Code>::max();
    return static_cast<Code>(std::floor(in_unit_range(value) * highest + threshold));
}

/// Divides colour by alpha; colour becomes 0 if alpha is 0.
void unpremultiply(float* rgb, float alpha) {
    const float scale = alpha > 0 ? 1.0f / alpha : 0.0f;
    for (int i = 0; i < 3; ++i)
        rgb[i] *= scale;
}

/// What is done to the pixels of one image.
struct CodeLayout {
    size_t channels;    ///< of a pixel of the image
    size_t colors;      ///< 1 or 3
    bool straight;      ///< colour is divided by alpha
    bool stores_alpha;  ///< the codes have a fourth channel
    bool dithered = false;

    size_t out_channels() const { return colors + (stores_alpha ? 1 : 0); }
};

CodeLayout layout_of(const OutputImage& image, bool keep_alpha, const DisplayEncoding& encoding) {
    const size_t channels = image.channels.size();
    const bool has_alpha = channels == 4;
    const bool over_page = has_alpha && encoding.page;
    return {channels,
            channels >= 3 ? size_t{3} : size_t{1},
            has_alpha && (keep_alpha || over_page),
            has_alpha && keep_alpha && !over_page,
            encoding.dither && encoding.transform && channels >= 3};
}

/// The encoded colours of pixels [begin, end), before they are rounded.
std::vector<float> encoded_colors(const OutputImage& image,
                                  const CodeLayout& layout,
                                  const DisplayEncoding& encoding,
                                  size_t begin,
                                  size_t end) {
    std::vector<float> colors((end - begin) * layout.colors);
    const auto alpha_of = [&](size_t pixel) {
        return in_unit_range(image.pixels[pixel * layout.channels + 3]);
    };
    for (size_t i = begin; i < end; ++i) {
        float* color = colors.data() + (i - begin) * layout.colors;
        std::copy_n(image.pixels.data() + i * layout.channels, layout.colors, color);
        if (layout.straight) unpremultiply(color, alpha_of(i));
    }
    if (encoding.transform && layout.colors == 3) {
        encoding.transform->apply(colors.data(), end - begin);
    }
    if (layout.straight && encoding.page) {
        for (size_t i = begin; i < end; ++i) {
            const float alpha = alpha_of(i);
            float* color = colors.data() + (i - begin) * 3;
            for (size_t c = 0; c < 3; ++c) {
                color[c] = alpha * in_unit_range(color[c]) + (1 - alpha) * (*encoding.page)[c];
            }
        }
    }
    return colors;
}

}  // namespace

template <typename Code>
std::vector<Code> display_codes(const OutputImage& image,
                                bool keep_alpha,
                                const DisplayEncoding& encoding) {
    constexpr size_t grain = 4096;
    CodeLayout layout = layout_of(image, keep_alpha, encoding);
    layout.dithered = layout.dithered && sizeof(Code) == 1;
    const size_t count = image.pixels.size() / layout.channels;
    const auto width = static_cast<size_t>(image.width);
    std::vector<Code> codes(count * layout.out_channels());
    parallel_ranges(count, grain, [&](size_t begin, size_t end) {
        const std::vector<float> colors = encoded_colors(image, layout, encoding, begin, end);
        for (size_t i = begin; i < end; ++i) {
            // All channels share the threshold, so that grey stays grey.
            const float threshold = layout.dithered ? dither_threshold(i % width, i / width) : 0.5f;
            const float* color = colors.data() + (i - begin) * layout.colors;
            Code* out = codes.data() + i * layout.out_channels();
            for (size_t c = 0; c < layout.colors; ++c)
                out[c] = code_of<Code>(color[c], threshold);
            if (layout.stores_alpha) {
                out[3] = code_of<Code>(image.pixels[i * layout.channels + 3], 0.5f);
            }
        }
    });
    return codes;
}

template std::vector<uint8_t> display_codes(const OutputImage&, bool, const DisplayEncoding&);
template std::vector<uint16_t> display_codes(const OutputImage&, bool, const DisplayEncoding&);

}  // namespace obscura
