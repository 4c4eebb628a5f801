// image/environment_memory.h - how many bytes an environment takes, as an image and as tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

/// Three floats a pixel as they are read; four in EnvironmentTable, and a word and a float of the
/// tables that choose pixels.
inline uint64_t environment_memory_bytes(int64_t width, int64_t height) {
    constexpr uint64_t bytes_per_pixel = 3 * 4 + 4 * 4 + 2 * 4;
    return bytes_per_pixel * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
}

}  // namespace obscura
