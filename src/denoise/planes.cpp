// denoise/planes.cpp - one channel of an image with a border around it, and blurring.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/planes.h"

namespace obscura {

void Plane::extend() {
    for (int y = 0; y < height_; ++y) {
        float* const at = row(y);
        std::fill(at - border_, at, at[0]);
        std::fill(at + width_, at + width_ + border_, at[width_ - 1]);
    }
    for (int y = 1; y <= border_; ++y) {
        std::copy_n(row(0) - border_, stride_, row(-y) - border_);
        std::copy_n(row(height_ - 1) - border_, stride_, row(height_ - 1 + y) - border_);
    }
}

Plane box_blur(const Plane& from, int radius) {
    Plane across(from.width(), from.height(), from.border());
    const float scale = 1.0f / static_cast<float>(2 * radius + 1);
    for_rows(from.height(), [&](int y) {
        const float* const in = from.row(y);
        float* const out = across.row(y);
        std::fill(out, out + from.width(), 0.0f);
        for (int d = -radius; d <= radius; ++d) {
            for (int x = 0; x < from.width(); ++x)
                out[x] += in[x + d];
        }
        for (int x = 0; x < from.width(); ++x)
            out[x] *= scale;
    });
    across.extend();
    Plane both(from.width(), from.height(), from.border());
    for_rows(from.height(), [&](int y) {
        float* const out = both.row(y);
        for (int d = -radius; d <= radius; ++d) {
            const float* const in = across.row(y + d);
            for (int x = 0; x < from.width(); ++x)
                out[x] += in[x];
        }
        for (int x = 0; x < from.width(); ++x)
            out[x] *= scale;
    });
    both.extend();
    return both;
}

}  // namespace obscura
