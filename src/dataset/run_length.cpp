// dataset/run_length.cpp - masks as run lengths, as COCO's annotations have them.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/run_length.h"

namespace obscura::dataset {

std::vector<uint32_t> run_lengths(std::span<const uint8_t> mask, size_t width, size_t height) {
    std::vector<uint32_t> out = {0};
    bool is_inside = false;
    for (size_t x = 0; x < width; ++x) {
        for (size_t y = 0; y < height; ++y) {
            if ((mask[y * width + x] != 0) != is_inside) {
                is_inside = !is_inside;
                out.push_back(0);
            }
            ++out.back();
        }
    }
    return out;
}

std::string coco_counts(std::span<const uint32_t> lengths) {
    constexpr int group_bits = 5;
    constexpr int64_t group_mask = 31, sign_bit = 16, more_follow = 32;
    std::string out;
    for (size_t i = 0; i < lengths.size(); ++i) {
        int64_t rest = lengths[i];
        if (i > 2) rest -= lengths[i - 2];
        for (bool ends = false; !ends;) {
            const int64_t group = rest & group_mask;
            rest >>= group_bits;
            // What is left is the sign alone, and the group's highest bit has it.
            ends = rest == ((group & sign_bit) != 0 ? -1 : 0);
            out += static_cast<char>('0' + group + (ends ? 0 : more_follow));
        }
    }
    return out;
}

}  // namespace obscura::dataset
