// gltf/decode/encoded_image.h - the bytes of an asset's image, from a buffer, a file or a data URI.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/memory_budget.h"
#include "gltf/decode/buffers.h"

#include <filesystem>
#include <span>
#include <string>

namespace obscura::gltf {

/// Where an asset's images come from.
struct ImageSources {
    const Document& document;
    const BufferStore& buffers;
    const std::filesystem::path& folder;  ///< the asset's
    bool measure_only = false;            ///< nothing will be decoded
};

/// An image's encoded bytes: owned, or inside a buffer.
struct EncodedImage {
    Bytes owned;
    std::span<const std::byte> bytes;
    std::string mime;          ///< what the asset says it is
    MemoryCharge charge = {};  ///< of `owned`
};

/// Errors  67 E-RES-MISSING; 65 E-URI-DATA; 77 E-URI-REFUSED, E-LIMIT-FILE; 33 E-MEM
Result<EncodedImage> load_encoded(const ImageSources& sources, size_t image);

}  // namespace obscura::gltf
