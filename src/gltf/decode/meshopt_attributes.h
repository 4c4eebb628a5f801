// gltf/decode/meshopt_attributes.h - version 1 of KHR_meshopt_compression's attribute codec.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/file_bytes.h"

#include <span>

namespace obscura::gltf {

/// Elements of equal size.
struct ElementLayout {
    uint64_t count = 0;
    uint64_t stride = 0;  ///< bytes: a multiple of 4 up to 256
};

/// Decodes data that begin with the byte 0xa1; older versions of the library know only 0xa0.
///
/// Out     count * stride bytes, which `out` already has
/// Errors  false: the data are corrupt, too short or too long
/// Source  glTF extension KHR_meshopt_compression, appendix A, "Mode 0: attributes"
bool decode_attributes_v1(std::span<const std::byte> from, const ElementLayout& layout, Bytes& out);

}  // namespace obscura::gltf
