// dataset/run_length.h - masks as run lengths, as COCO's annotations have them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura::dataset {

/// Lengths of runs of a mask, column after column from the left, each from the top: first those
/// outside (may be 0), then inside, and so on in turn.
///
/// In      inside: indices of the pixels inside, row after row, each once
std::vector<uint32_t> run_lengths(std::span<const uint32_t> inside, size_t width, size_t height);

/// Run lengths as the text that COCO's API reads as `counts`: from the third length on, the
/// difference to the one two before; each number in groups of five bits, the lowest first, as
/// characters from '0' on, with 32 added where a group follows.
///
/// Source  the format of COCO's API, github.com/cocodataset/cocoapi, "run-length encoding"
std::string coco_counts(std::span<const uint32_t> lengths);

}  // namespace obscura::dataset
