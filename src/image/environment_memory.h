// image/environment_memory.h - how many bytes an environment takes, as an image and as tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

/// Three floats a pixel as they are read.
inline uint64_t environment_image_bytes(int64_t width, int64_t height) {
    return 12 * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
}

/// Four floats a pixel in EnvironmentTable, and a word and a float of the tables that choose
/// pixels.
inline uint64_t environment_table_bytes(int64_t width, int64_t height) {
    return (16 + 8) * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
}

}  // namespace obscura
