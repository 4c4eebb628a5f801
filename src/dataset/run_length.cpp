// dataset/run_length.cpp - masks as run lengths, as COCO's annotations have them.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/run_length.h"

#include <algorithm>

namespace obscura::dataset {

std::vector<uint32_t> run_lengths(std::span<const uint32_t> inside, size_t width, size_t height) {
    std::vector<size_t> places;  // column after column
    places.reserve(inside.size());
    for (const uint32_t pixel : inside)
        places.push_back(pixel % width * height + pixel / width);
    std::sort(places.begin(), places.end());
    std::vector<uint32_t> out;
    size_t end = 0;  // of the runs so far
    for (size_t i = 0; i < places.size();) {
        size_t last = i;
        while (last + 1 < places.size() && places[last + 1] == places[last] + 1)
            ++last;
        out.push_back(static_cast<uint32_t>(places[i] - end));
        out.push_back(static_cast<uint32_t>(last + 1 - i));
        end = places[last] + 1;
        i = last + 1;
    }
    if (end < width * height) out.push_back(static_cast<uint32_t>(width * height - end));
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
