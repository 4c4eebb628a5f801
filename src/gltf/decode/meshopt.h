// gltf/decode/meshopt.h - decompresses the buffer views of EXT_ and KHR_meshopt_compression.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/buffers.h"

namespace obscura::gltf {

/// Fills BufferStore::decoded, all views at once on all cores; afterwards view_bytes gives what the
/// views hold.
///
/// Errors  65 E-MESHOPT-DATA the data are corrupt or too few for their count;
///         69 E-MESHOPT-VERSION an unknown codec; 77 E-LIMIT-DECODED more than max_decoded_bytes;
///         33 E-MEM
/// Source  glTF extensions EXT_meshopt_compression and KHR_meshopt_compression, appendices A and B
Result<void> decode_meshopt(const Document& document, BufferStore& store);

/// Limit on the decoded bytes of all compressed data of an asset.
inline constexpr uint64_t max_decoded_bytes = 1ULL << 33;

}  // namespace obscura::gltf
