// gltf/decode/accessors.h - reads accessors into flat arrays of float or uint32.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/buffers.h"
#include "gltf/parse/document.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura::gltf {

/// Bytes of one element; columns of matrices start at multiples of 4.
uint64_t element_size(const GltfAccessor& accessor);

/// Numbers in one element: 1 for a scalar, 16 for a 4x4 matrix.
size_t component_count(const GltfAccessor& accessor);

/// Checks an accessor against its views by arithmetic alone; empty: it is well formed.
std::string accessor_problem(const Document& document, const GltfAccessor& accessor);

bool accessor_is_misaligned(const Document& document, const GltfAccessor& accessor);

/// False when a sparse accessor's indices do not increase, which glTF forbids. They are read
/// anyway; of equal indices the last one counts.
bool sparse_indices_increase(const Document& document, const BufferStore& store, int accessor);

/// Which elements of an accessor are read.
struct ElementChoice {
    bool all = true;
    std::span<const uint32_t> elements = {};  ///< when not `all`: each below the count
};

/// Reads elements as floats, component by component; normalised integers become [0,1] or [-1,1].
///
/// In      packed: decompressed elements, read in place of the accessor's view; empty: the view's
///         elements are read
/// Out     component_count floats an element
/// Errors  65 E-ACC-SPARSE a sparse index is not below the count, E-ACC-RANGE data are missing;
///         77 E-LIMIT-COUNT too many elements without data
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

}  // namespace obscura::gltf
