// gltf/decode/accessors.h - accessors as flat arrays of float or uint32.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/buffers.h"
#include "gltf/parse/document.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// Bytes of one element; columns of matrices start at multiples of 4.
uint64_t element_size(const GltfAccessor& accessor);

/// Numbers in one element: 1 for a scalar, 16 for a 4x4 matrix.
size_t component_count(const GltfAccessor& accessor);

/// Checks an accessor against its views by arithmetic alone; empty: it is well formed.
std::string accessor_problem(const Document& document, const GltfAccessor& accessor);

bool accessor_is_misaligned(const Document& document, const GltfAccessor& accessor);

/// False when a sparse accessor's indices do not increase, which glTF forbids; they are read all
/// the same, the last of equal ones counts.
bool sparse_indices_increase(const Document& document, const BufferStore& store, int accessor);

/// Which elements of an accessor are read.
struct ElementChoice {
    bool all = true;
    std::span<const uint32_t> elements = {};  ///< unless all: each below the count
};

/// Reads elements as floats, component by component; normalised integers become [0,1] or [-1,1].
///
/// In      packed: elements that stand for those of the accessor's view, as decompression made
/// them;
///         empty: the view's are read
/// Out     component_count floats an element
/// Errors  65 E-ACC-SPARSE a sparse index is not below the count, E-ACC-RANGE data are missing;
///         77 E-LIMIT-COUNT too many elements that no data stand for
Result<std::vector<float>> read_floats(const Document& document,
                                       const BufferStore& store,
                                       int accessor,
                                       const ElementChoice& choice,
                                       std::span<const std::byte> packed = {});

/// Reads a scalar accessor of unsigned integers.
///
/// Errors  as read_floats; 65 E-ACC-TYPE when it is not one
Result<std::vector<uint32_t>> read_indices(const Document& document,
                                           const BufferStore& store,
                                           int accessor);

}  // namespace obscura
