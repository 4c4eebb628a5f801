// python/module/pixels.h - pixels of the library as arrays of NumPy.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "convert.h"

namespace obscura::python {

struct PixelShape {
    int width = 0, height = 0;
    std::size_t channels = 0;
};

/// An array on the pixels themselves, (height, width, channels) float32; it keeps `owner` alive.
py::array_t<float> pixels_of(const PixelShape& shape,
                             const std::vector<float>& pixels,
                             const py::object& owner);

}  // namespace obscura::python
