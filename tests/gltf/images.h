// tests/gltf/images.h - small images for glTF assets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/gltf_files.h"
#include "image/ktx2_builder.h"
#include "image/png_builder.h"

#include <algorithm>
#include <string>
#include <vector>

namespace obscura::gltf::test {

/// An RGBA PNG whose texel (x, y) is (10 x, 10 y, 77, 255), as a file's bytes.
inline std::string png_bytes(unsigned width, unsigned height) {
    std::vector<std::vector<unsigned>> rows(height);
    for (unsigned y = 0; y < height; ++y) {
        for (unsigned x = 0; x < width; ++x) {
            for (const unsigned byte : {10 * x, 10 * y, 77U, 255U})
                rows[y].push_back(byte);
        }
    }
    const auto bytes = testing_images::PngBuilder(width, height, 8, 6).finish(rows);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline std::string png_uri(unsigned width, unsigned height) {
    return "data:image/png;base64," + base64(png_bytes(width, height));
}

/// A WebP image of one grey pixel (lossless).
inline std::string webp_bytes() {
    static constexpr unsigned char bytes[] = {0x52, 0x49, 0x46, 0x46, 0x1A, 0x00, 0x00, 0x00, 0x57,
                                              0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x4C, 0x0D, 0x00,
                                              0x00, 0x00, 0x2F, 0x00, 0x00, 0x00, 0x10, 0x07, 0x10,
                                              0x11, 0x11, 0x88, 0x88, 0xFE, 0x07, 0x00};
    return {reinterpret_cast<const char*>(bytes), sizeof(bytes)};
}

inline std::string ktx2_uri(const testing_images::Ktx2Parts& parts) {
    const auto bytes = testing_images::ktx2_file(parts);
    return "data:image/ktx2;base64," +
           base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// sRGB, `width` x 1, each level of one grey: 10, 20, 30 ...
inline testing_images::Ktx2Parts ktx2_greys(unsigned width, unsigned levels) {
    testing_images::Ktx2Parts parts;
    parts.format = 43;
    parts.transfer = 2;
    parts.width = width;
    for (unsigned level = 0; level < levels; ++level) {
        const unsigned grey = 10 * (level + 1);
        parts.levels.emplace_back();
        for (unsigned x = 0; x < std::max(width >> level, 1U); ++x)
            testing_images::append(parts.levels.back(), {grey, grey, grey, 255});
    }
    return parts;
}

}  // namespace obscura::gltf::test
