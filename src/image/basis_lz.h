// image/basis_lz.h - BasisLZ decoding: codebooks of ETC1S colours and selectors, and slices.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/etc1s.h"
#include "image/huffman.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace obscura {

/// Codebooks that all slices of a file share.
struct BasisLzCodebooks {
    std::vector<Etc1sEndpoint> endpoints;
    std::vector<Etc1sSelectors> selectors;
};

/// The Huffman codes of a slice's symbols.
struct BasisLzCodes {
    HuffmanTable endpoint_prediction;  ///< how the endpoints of four blocks are predicted
    HuffmanTable endpoint_delta;
    HuffmanTable selector;
    HuffmanTable selector_run;
    uint32_t history_size = 0;  ///< size of the selector history
};

/// A block as two numbers, below the lengths of the codebooks.
struct BasisLzBlock {
    uint16_t endpoint = 0;
    uint16_t selector = 0;
};

// All of these return nullopt for truncated or contradictory data, and never read past the end.
//
// Source  KTX 2.0, appendix "BasisLZ/ETC1S Bitstream Specification"

std::optional<std::vector<Etc1sEndpoint>> read_endpoints(std::span<const std::byte> bytes,
                                                         size_t count);

std::optional<std::vector<Etc1sSelectors>> read_selectors(std::span<const std::byte> bytes,
                                                          size_t count);

std::optional<BasisLzCodes> read_slice_codes(std::span<const std::byte> bytes);

/// The blocks of one image, row by row.
std::optional<std::vector<BasisLzBlock>> read_slice(std::span<const std::byte> bytes,
                                                    const BasisLzCodebooks& books,
                                                    const BasisLzCodes& codes,
                                                    size_t columns,
                                                    size_t rows);

}  // namespace obscura
