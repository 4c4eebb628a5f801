// gltf/decode/buffers.h - loads a document's buffers; bounds-checked access to their bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/file_bytes.h"
#include "base/memory_budget.h"
#include "gltf/parse/document.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace obscura::gltf {

/// The bytes of every buffer. Buffers from files and data URIs are owned; a GLB's chunk belongs to
/// the caller.
struct BufferStore {
    std::vector<std::span<const std::byte>> buffers;
    std::vector<Bytes> owned;
    /// By view, once decode_meshopt has run: empty for views that are not compressed.
    std::vector<Bytes> decoded = {};
    std::vector<MemoryCharge> charges = {};  ///< of `owned`
    MemoryCharge decoded_charge = {};
};

/// Where buffers come from.
struct BufferSources {
    std::filesystem::path folder;  ///< the asset's
    std::optional<std::span<const std::byte>> glb_binary;
};

/// Loads every buffer that is read. One that holds (or would hold) only uncompressed copies of
/// meshopt-compressed views stays empty.
///
/// Errors  33 E-MEM; 65 E-BUF-*; 67 E-RES-MISSING, E-RES-SHORT; 77 E-URI-REFUSED: the first error,
///         with all others in Error::also
Result<BufferStore> load_buffers(const Document& document, const BufferSources& sources, Log& log);

/// A run of equally spaced elements in a block of bytes.
struct ElementRange {
    uint64_t offset = 0;
    uint64_t stride = 0;
    uint64_t count = 0;
    uint64_t element_size = 0;
};

/// Length of a range from its offset: (count - 1) * stride + element_size. Nothing when that
/// overflows or the range ends behind `total`. A count of 0 has length 0; only its offset must fit.
std::optional<uint64_t> range_extent(const ElementRange& range, uint64_t total);

/// The bytes of a range, if all of them exist.
std::optional<std::span<const std::byte>> checked_span(std::span<const std::byte> bytes,
                                                       const ElementRange& range);

/// Frees the buffers that hold no images, once the geometry has been read.
void release_geometry(const Document& document, BufferStore& store);

/// The bytes of a buffer view, decompressed; empty when its buffer has no data.
std::span<const std::byte> view_bytes(const Document& document, const BufferStore& store, int view);

}  // namespace obscura::gltf
