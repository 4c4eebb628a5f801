// scene/texel_span.h - the texels under one texel of the next mip level, along one axis.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura {

/// The run of source texels under one texel.
struct TexelSpan {
    int first;
    int count;        ///< 1 to 3
    float weight[3];  ///< sum 1
};

/// In      size: of the next level, half of source_size rounded down, at least 1
inline TexelSpan span_under(int index, int source_size, int size) {
    if (source_size == 1) return {0, 1, {1.0f, 0.0f, 0.0f}};
    if (source_size % 2 == 0) return {2 * index, 2, {0.5f, 0.5f, 0.0f}};
    // In units of 1/size source texels, this texel is [index, index + 1) * source_size.
    const auto whole = static_cast<float>(source_size);
    return {2 * index,
            3,
            {static_cast<float>(size - index) / whole,
             static_cast<float>(size) / whole,
             static_cast<float>(index + 1) / whole}};
}

}  // namespace obscura
