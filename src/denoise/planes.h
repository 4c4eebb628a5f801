// denoise/planes.h - one channel of an image with a border around it, and blurring.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace obscura {

/// One channel with a border, so that windows need not ask where the image ends.
class Plane {
public:
    Plane() = default;
    Plane(int width, int height, int border)
        : width_(width),
          height_(height),
          border_(border),
          stride_(static_cast<size_t>(width + 2 * border)),
          values_(stride_ * static_cast<size_t>(height + 2 * border), 0.0f) {}

    int width() const { return width_; }
    int height() const { return height_; }
    int border() const { return border_; }

    /// Row y, from -border to height + border; x likewise.
    float* row(int y) { return values_.data() + offset(y); }
    const float* row(int y) const { return values_.data() + offset(y); }

    /// Fills the border with the nearest pixels.
    void extend();

private:
    size_t offset(int y) const {
        return static_cast<size_t>(y + border_) * stride_ + static_cast<size_t>(border_);
    }

    int width_ = 0, height_ = 0, border_ = 0;
    size_t stride_ = 0;
    std::vector<float> values_;
};

using Rgb = std::array<Plane, 3>;

/// Rows that one task takes.
inline constexpr int rows_per_task = 16;

/// Calls `body(y)` for every row, on all threads.
template <typename Body>
void for_rows(int height, const Body& body) {
    parallel_ranges(static_cast<size_t>(height), rows_per_task, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            body(static_cast<int>(y));
    });
}

/// A plane of values by pixel: `value(x, y)`. Its border is extended.
template <typename Value>
Plane make_plane(int width, int height, int border, const Value& value) {
    Plane out(width, height, border);
    for_rows(height, [&](int y) {
        float* const row = out.row(y);
        for (int x = 0; x < width; ++x)
            row[x] = value(x, y);
    });
    out.extend();
    return out;
}

/// The mean over squares of 2 * radius + 1 pixels a side; its border is extended.
Plane box_blur(const Plane& from, int radius);

}  // namespace obscura
