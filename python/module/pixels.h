// python/module/pixels.h - pixels of the library as arrays of NumPy.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "convert.h"

namespace obscura::python {

/// Bytes from one element to the next, along each side. They are told because pybind11 before 2.12
/// asks NumPy for the size of an element, which it does not find in NumPy 2.
template <typename T, std::size_t n>
std::array<py::ssize_t, n> strides_of(const std::array<py::ssize_t, n>& sides) {
    std::array<py::ssize_t, n> out = {};
    py::ssize_t bytes = sizeof(T);
    for (std::size_t i = n; i-- > 0; bytes *= sides[i])
        out[i] = bytes;
    return out;
}

struct PixelShape {
    int width = 0, height = 0;
    std::size_t channels = 0;
};

/// An array on the pixels themselves, (height, width, channels) float32; it keeps `owner` alive.
py::array_t<float> pixels_of(const PixelShape& shape,
                             const std::vector<float>& pixels,
                             const py::object& owner);

}  // namespace obscura::python
